// SPDX-License-Identifier: BSD-3-Clause
// MovingInDepth: what moves before a depth camera, by the contradiction with free space.
#pragma once

#include <optional>

#include "roomgraph/lidar/free_space_memory.h"
#include "roomgraph/mapping/range_fan.h"

namespace roomgraph {

/// What moves before a depth camera, whatever a detector says (method.md sec. 5): returns of slices in space that earlier slices saw as free.
class MovingInDepth {
 public:
  MovingInDepth();
  /// Makes the beams of such returns unknown; returns how many. The robot's pose is in any frame of a source of movements, which drifts, but
  /// does not jump within a `segment`; where a new one begins nothing is known.
  int leaveOut(RangeFan& slice, const Pose3& odom_from_robot, int segment);

 private:
  FreeSpaceMemory memory_;
  Pose3 level_from_odom_ = Pose3::Identity();  ///< the frame of the segment's first slice, which is level
  std::optional<int> segment_;
};

}  // namespace roomgraph
