// SPDX-License-Identifier: BSD-3-Clause
// Text of the objects seen from a node, and robust means over nodes.
#include "roomgraph/graphslam/seen_object.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roomgraph {

std::string describe(const std::vector<SeenObject>& objects) {
  std::string out;
  for (const auto& object : objects) {
    const Eigen::Vector3d place = object.node_from_object.translation();
    char text[96];
    std::snprintf(text, sizeof text, " %lld (%.2f %.2f %.2f)", static_cast<long long>(object.landmark.value), place.x(),
                  place.y(), place.z());
    out += (out.empty() ? "" : ", ") + object.class_name + text;
  }
  return out;
}

namespace {

constexpr double kCauchy = 2.3849;  // 95 % of the efficiency of least squares where errors are normal
constexpr int kRounds = 10;

/// A sighting as its node tells it.
struct PlacedSighting {
  const SeenObject* seen;
  Pose3 world_from_object;
  double weight = 0;
};

Eigen::Vector3d robustPlace(std::vector<PlacedSighting>& sightings) {
  for (auto& sighting : sightings) sighting.weight = 1 / std::pow(sighting.seen->sigma_m, 2);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const auto& sighting : sightings) {
      sum += sighting.weight * sighting.world_from_object.translation();
      weights += sighting.weight;
    }
    mean = sum / weights;
    for (auto& sighting : sightings) {
      const double variance = std::pow(sighting.seen->sigma_m, 2);
      const double off2 = (sighting.world_from_object.translation() - mean).squaredNorm() / variance;
      sighting.weight = 1 / variance / (1 + off2 / (kCauchy * kCauchy));
    }
  }
  return mean;
}

PlacedObject placedBy(std::vector<PlacedSighting>& sightings) {
  PlacedObject out;
  out.nodes = static_cast<int>(sightings.size());
  out.position = robustPlace(sightings);
  std::map<std::string, int> names;
  std::map<int, Eigen::Vector2d> fronts;  // by symmetry, turned so that what looks alike falls together
  double weights = 0;
  for (const auto& [seen, placed, weight] : sightings) {
    ++names[seen->class_name];
    out.size_m += weight * seen->size_m;
    weights += weight;
    const double yaw = std::atan2(placed.linear()(1, 0), placed.linear()(0, 0)) * seen->symmetry;
    if (seen->symmetry > 0)
      fronts.try_emplace(seen->symmetry, Eigen::Vector2d::Zero()).first->second +=
          weight * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  }
  out.size_m /= weights;
  out.class_name = std::max_element(names.begin(), names.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  const auto best = std::max_element(fronts.begin(), fronts.end(), [](const auto& a, const auto& b) {
    return a.second.norm() < b.second.norm();
  });
  if (best == fronts.end()) return out;
  out.has_yaw = true;
  out.yaw = std::atan2(best->second.y(), best->second.x()) / best->first;
  return out;
}

}  // namespace

std::map<LandmarkId, PlacedObject> placeObjects(
    const std::vector<std::pair<Pose3, std::vector<SeenObject>>>& nodes) {
  std::map<LandmarkId, std::vector<PlacedSighting>> sightings;
  for (const auto& [world_from_node, seen] : nodes)
    for (const auto& object : seen)
      sightings[object.landmark].push_back({&object, world_from_node * object.node_from_object});
  std::map<LandmarkId, PlacedObject> out;
  for (auto& [id, of] : sightings) out[id] = placedBy(of);
  return out;
}

}  // namespace roomgraph
