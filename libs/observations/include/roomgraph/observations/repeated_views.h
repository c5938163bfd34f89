// SPDX-License-Identifier: BSD-3-Clause
// Which views of a long recording repeat others: what is kept is to grow with the area seen, not with time.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// How many views of a place are kept.
struct ViewLimits {
  std::size_t of_a_view = 8;  ///< taken from one place in one direction; at least 2
  double place_m = 0.5, direction_rad = 0.35;
};

/// Positions, in ascending order, of the views (their times, s, in order) that are to be given up so that no more than the
/// limit are left from any place (a cell on the ground) in any direction (of the robot's yaw). Those that stay are spread over
/// time; the first and the last of a place and direction stay, and so do views whose pose is not known. Throws
/// std::invalid_argument for limits that are none.
std::vector<std::size_t> repeatedViews(const std::vector<double>& times, const Trajectory& world_from_robot,
                                       const ViewLimits& limits);

/// Removes the elements at these positions, which are in ascending order, and what memory they leave.
template <typename Element>
void eraseAt(std::vector<Element>& elements, const std::vector<std::size_t>& positions) {
  std::vector<Element> kept;
  kept.reserve(elements.size() - positions.size());
  auto next = positions.begin();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (next != positions.end() && *next == i) {
      ++next;
    } else {
      kept.push_back(std::move(elements[i]));
    }
  }
  elements = std::move(kept);
}

/// Says when something that grows is to be looked through again: each time that it has grown by a quarter.
class GrowthWatch {
 public:
  bool due(std::size_t size, std::size_t from) const { return size > from && size > next_; }
  /// It was looked through, and has this size now.
  void done(std::size_t size) { next_ = size + size / 4; }

 private:
  std::size_t next_ = 0;
};

/// Gives up the elements that repeat others, now and then when there are more than `kept`. They are in order of `time` (s, of an
/// element).
template <typename Element, typename Time>
void giveUpRepeated(std::vector<Element>& elements, GrowthWatch& watch, std::size_t kept, const Trajectory& world_from_robot,
                    const Time& time, const ViewLimits& limits = {}) {
  if (!watch.due(elements.size(), kept)) return;
  std::vector<double> times;
  for (const Element& element : elements) times.push_back(time(element));
  eraseAt(elements, repeatedViews(times, world_from_robot, limits));
  watch.done(elements.size());
}

}  // namespace roomgraph
