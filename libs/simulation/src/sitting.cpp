// SPDX-License-Identifier: BSD-3-Clause
// Palettes, and heights and depths of seats.
#include "sitting.h"

#include <map>
#include <string>

namespace roomgraph {

const std::vector<std::array<double, 3>>& skinColors() {
  static const std::vector<std::array<double, 3>> colors{
      {0.85, 0.65, 0.52}, {0.62, 0.44, 0.33}, {0.42, 0.29, 0.21}, {0.93, 0.76, 0.65}};
  return colors;
}

const std::vector<std::array<double, 3>>& hairColors() {
  static const std::vector<std::array<double, 3>> colors{
      {0.2, 0.13, 0.08}, {0.08, 0.07, 0.07}, {0.55, 0.4, 0.2}, {0.6, 0.6, 0.58}};
  return colors;
}

std::optional<double> seatHeight(const Furniture& item) {
  static const std::map<std::string, double> heights{{"swivel_chair", 0.46},
                                                     {"sofa", 0.43},
                                                     {"wooden_chair", 0.46},
                                                     {"visitor_chair", 0.46},
                                                     {"armchair", 0.43}};
  if (item.model == "stool") return item.size_m->z();
  const auto height = heights.find(item.model);
  return height == heights.end() ? std::nullopt : std::optional(height->second);
}

Pose2 placeOnSeat(const Furniture& seat, double along_m) {
  const bool deep = seat.model == "sofa" || seat.model == "armchair";
  return Pose2{seat.at_m.x(), seat.at_m.y(), seat.yaw_rad} * Pose2{deep ? 0.06 : -0.02, along_m, 0};
}

}  // namespace roomgraph
