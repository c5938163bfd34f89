// SPDX-License-Identifier: BSD-3-Clause
// Sightings that agree with the latest one, and whether they are enough.
#include "roomgraph/estimation/place_consensus.h"

#include <algorithm>

namespace roomgraph {
namespace {

constexpr double kTurnLength_m = 0.5;  // a radian turned counts as this way

// Way between two times, by the key poses in between.
double wayBetween(const KeyPoses& poses, double t_a, double t_b) {
  Pose3 last = poses.at(t_a);
  double way = 0;
  const auto step = [&](const Pose3& next) {
    const Pose3 moved = last.inverse() * next;
    way += moved.translation().norm() + kTurnLength_m * rotationAngle(moved);
    last = next;
  };
  for (const KeyPose& node : poses.nodes())
    if (node.t > t_a && node.t < t_b) step(node.world_from_robot);
  step(poses.at(t_b));
  return way;
}

}  // namespace

std::string toString(PlaceSource source) {
  switch (source) {
    case PlaceSource::kObjects:
      return "objects";
    case PlaceSource::kScans:
      return "scans";
    case PlaceSource::kImages:
      return "images";
  }
  return "";
}

void PlaceConsensus::add(const PlaceSighting& sighting) {
  std::erase_if(sightings_, [&](const PlaceSighting& old) { return old.t < sighting.t - options_.recent_s; });
  sightings_.push_back(sighting);
}

std::optional<ConfirmedPlace> PlaceConsensus::confirmed(const KeyPoses& poses) const {
  if (sightings_.empty()) return std::nullopt;
  const PlaceSighting& latest = sightings_.back();
  const Pose3 robot_now = poses.at(latest.t);
  ConfirmedPlace out{latest.map_from_robot * robot_now.inverse(), {}, 0};
  double first_t = latest.t;
  for (const PlaceSighting& sighting : sightings_) {
    // What it says about the place of now, by the way since.
    const Pose3 now = sighting.map_from_robot * poses.at(sighting.t).inverse() * robot_now;
    const Pose3 error = latest.map_from_robot.inverse() * now;
    if (error.translation().norm() > options_.tolerance_m || rotationAngle(error) > options_.tolerance_rad)
      continue;
    ++out.sightings;
    first_t = std::min(first_t, sighting.t);
    if (std::find(out.sources.begin(), out.sources.end(), sighting.source) == out.sources.end())
      out.sources.push_back(sighting.source);
  }
  std::sort(out.sources.begin(), out.sources.end());
  const int others = static_cast<int>(sightings_.size()) - out.sightings;
  if (others > options_.rival_share * out.sightings) return std::nullopt;
  if (out.sources.size() > 1 && out.sightings >= options_.agreeing) return out;
  const bool on_a_way =
      latest.t - first_t >= options_.alone_s && wayBetween(poses, first_t, latest.t) >= options_.alone_m;
  if (out.sightings >= options_.agreeing_alone && on_a_way) return out;
  return std::nullopt;
}

}  // namespace roomgraph
