// SPDX-License-Identifier: BSD-3-Clause
// Text of the objects seen from a node.
#include "roomgraph/graphslam/seen_object.h"

#include <cstdio>

namespace roomgraph {

std::string describe(const std::vector<SeenObject>& objects) {
  std::string out;
  for (const auto& object : objects) {
    char place[80];
    std::snprintf(place, sizeof place, " %lld (%.2f %.2f %.2f)", static_cast<long long>(object.landmark.value),
                  object.in_robot.x(), object.in_robot.y(), object.in_robot.z());
    out += (out.empty() ? "" : ", ") + object.class_name + place;
  }
  return out;
}

}  // namespace roomgraph
