// SPDX-License-Identifier: BSD-3-Clause
// Views by cells of place and direction; of a cell those that are nearest to others in time.
#include "roomgraph/observations/repeated_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace roomgraph {
namespace {

using ViewCell = std::array<long, 3>;

ViewCell viewCellOf(const Pose3& world_from_robot, const ViewLimits& limits) {
  const Pose2 on_ground = planarPart(world_from_robot);
  return {std::lround(on_ground.x / limits.place_m), std::lround(on_ground.y / limits.place_m),
          std::lround(on_ground.yaw / limits.direction_rad)};
}

// Of the views of one cell, in turn the one whose neighbours are nearest to each other in time.
void giveUpOf(std::vector<std::size_t> cell, const std::vector<double>& times, std::size_t most,
              std::vector<std::size_t>& given_up) {
  const auto gap = [&](std::size_t i) { return times[cell[i + 1]] - times[cell[i - 1]]; };
  while (cell.size() > most) {
    std::size_t least = 1;
    for (std::size_t i = 2; i + 1 < cell.size(); ++i)
      if (gap(i) < gap(least)) least = i;
    given_up.push_back(cell[least]);
    cell.erase(cell.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

}  // namespace

std::vector<std::size_t> repeatedViews(const std::vector<double>& times, const Trajectory& world_from_robot,
                                       const ViewLimits& limits) {
  if (limits.of_a_view < 2 || !(limits.place_m > 0) || !(limits.direction_rad > 0))
    throw std::invalid_argument("at least two views are kept, of places and directions of some size");
  std::map<ViewCell, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (const auto pose = world_from_robot.at(times[i])) cells[viewCellOf(*pose, limits)].push_back(i);
  std::vector<std::size_t> given_up;
  for (const auto& [cell, views] : cells) giveUpOf(views, times, limits.of_a_view, given_up);
  std::sort(given_up.begin(), given_up.end());
  return given_up;
}

}  // namespace roomgraph
