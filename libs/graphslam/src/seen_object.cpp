// SPDX-License-Identifier: BSD-3-Clause
// Text of the objects seen from a node, and means over nodes.
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

std::map<LandmarkId, PlacedObject> placeObjects(
    const std::vector<std::pair<Pose3, std::vector<SeenObject>>>& nodes) {
  std::map<LandmarkId, PlacedObject> out;
  std::map<LandmarkId, Eigen::Vector2d> directions;
  std::map<LandmarkId, std::map<std::string, int>> names;
  for (const auto& [world_from_node, seen] : nodes)
    for (const auto& object : seen) {
      const Pose3 placed = world_from_node * object.node_from_object;
      PlacedObject& sum = out[object.landmark];
      ++sum.nodes;
      sum.position += placed.translation();
      sum.size_m += object.size_m;
      const Eigen::Vector2d front = placed.linear().col(0).head<2>();
      directions.try_emplace(object.landmark, Eigen::Vector2d::Zero()).first->second += front;
      ++names[object.landmark][object.class_name];
    }
  for (auto& [id, object] : out) {
    object.position /= object.nodes;
    object.size_m /= object.nodes;
    object.yaw = std::atan2(directions.at(id).y(), directions.at(id).x());
    const auto& of = names.at(id);
    object.class_name = std::max_element(of.begin(), of.end(), [](const auto& a, const auto& b) {
                          return a.second < b.second;
                        })->first;
  }
  return out;
}

}  // namespace roomgraph
