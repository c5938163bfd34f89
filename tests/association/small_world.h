// SPDX-License-Identifier: BSD-3-Clause
// Simulated row of identical chairs with drift, clutter and broken tracks.
#pragma once

#include <cmath>
#include <vector>

#include "random_poses.h"
#include "roomgraph/association/landmark_map.h"
#include "roomgraph/evaluation/association_error.h"
#include "sightings.h"

namespace roomgraph::test {

/// Sightings of chairs with the truth, as evaluateAssociations() wants it.
struct SmallWorld {
  std::vector<std::vector<WorldMeasurement>> frames;
  std::vector<TrueFrame> truth;
};

/// Normal deviate of unit variance (sum of twelve uniform ones).
inline double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform(0, 1);
  return sum;
}

/// Box that tells which chair it is.
inline Box2 boxOf(int chair) {
  return {100.0 * chair, 0, 100.0 * chair + 50, 50};
}

inline void addSighting(SmallWorld& world, int chair, double x, double y, double sigma_m, double score,
                        std::int64_t track) {
  WorldMeasurement seen = sightingAt(x, y, 0, sigma_m);
  seen.measurement.proposal.has_yaw = false;
  seen.measurement.proposal.score = score;
  seen.measurement.detection.box = boxOf(chair);
  seen.measurement.track = TrackId{track};
  seen.measurement.frame = FrameId{static_cast<std::int64_t>(world.frames.size()) - 1};
  seen.measurement.t = world.truth.back().t;
  world.frames.back().push_back(seen);
  world.truth.back().boxes.push_back({chair, "chair", "chair", boxOf(chair), 1});
}

inline void addFrame(SmallWorld& world) {
  world.truth.push_back({0.1 * static_cast<double>(world.frames.size()), {}});
  world.frames.emplace_back();
}

/// A robot passes a row of identical chairs there and back; its pose drifts by up to some 10 cm, detections
/// flicker, a proposal in twelve is half a metre off, a track now and then ends or jumps to the neighbour.
inline SmallWorld rowOfChairs(unsigned seed, int chairs = 6, double spacing_m = 0.8) {
  Random random(seed);
  SmallWorld world;
  std::vector<std::int64_t> track(static_cast<std::size_t>(chairs));
  std::int64_t next_track = 0;
  for (auto& id : track) id = next_track++;
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();
  for (int frame = 0; frame < 160; ++frame) {
    const double robot = spacing_m * chairs * (frame < 80 ? frame / 80.0 : (160 - frame) / 80.0);
    drift = 0.98 * drift + 0.012 * Eigen::Vector2d(normal(random), normal(random));
    addFrame(world);
    for (int chair = 0; chair < chairs; ++chair) {
      auto& id = track[static_cast<std::size_t>(chair)];
      const double ahead = spacing_m * chair - robot;
      if (std::abs(ahead) > 1.6 || random.uniform(0, 1) < 0.3) continue;
      if (random.uniform(0, 1) < 0.04) id = next_track++;
      if (chair > 0 && random.uniform(0, 1) < 0.01) std::swap(id, track[static_cast<std::size_t>(chair - 1)]);
      const double sigma = 0.08 + 0.05 * std::abs(ahead);
      const bool failed = random.uniform(0, 1) < 0.08;
      const double off = failed ? 0.5 : 0, angle = random.uniform(0, 2 * M_PI);
      addSighting(world, chair,
                  spacing_m * chair + drift.x() + sigma * normal(random) + off * std::cos(angle),
                  drift.y() + sigma * normal(random) + off * std::sin(angle), sigma, failed ? 0.3 : 0.7, id);
    }
  }
  return world;
}

/// What a run with this associator writes down.
inline std::vector<AssociatedFrame> runOnline(const SmallWorld& world, Associator& associator,
                                              LandmarkMap& map) {
  std::vector<AssociatedFrame> out;
  for (std::size_t f = 0; f < world.frames.size(); ++f) {
    out.push_back({world.truth[f].t, {}});
    for (const auto& association : associator.associate(world.frames[f], map.landmarks())) {
      const WorldMeasurement& seen = world.frames[f][association.measurement];
      const LandmarkId id = map.update(seen, association);
      associator.assigned(seen, id);
      out.back().boxes.push_back({"chair", seen.measurement.detection.box, static_cast<int>(id.value),
                                  !association.landmark.valid(), association.probability});
    }
    if (f % 20 == 19 && !map.mergeDuplicates().empty()) associator.identitiesChanged(map.identity());
  }
  return out;
}

inline std::vector<AssociatedFrame> writtenDown(const SmallWorld& world, const Reassociation& result) {
  std::vector<AssociatedFrame> out;
  for (std::size_t f = 0; f < world.frames.size(); ++f) {
    out.push_back({world.truth[f].t, {}});
    for (const auto& [association, landmark] : result.decisions[f]) {
      const auto& seen = world.frames[f][association.measurement];
      out.back().boxes.push_back({"chair", seen.measurement.detection.box, static_cast<int>(landmark.value),
                                  !association.landmark.valid(), association.probability});
    }
  }
  return out;
}

}  // namespace roomgraph::test
