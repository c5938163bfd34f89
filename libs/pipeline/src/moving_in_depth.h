// SPDX-License-Identifier: BSD-3-Clause
// MovingInDepth: what moves before a depth camera, by the contradiction with free space.
#pragma once

#include "roomgraph/lidar/free_space_memory.h"
#include "roomgraph/mapping/range_fan.h"

namespace roomgraph {

/// What moves before a depth camera, whatever a detector says (method.md sec. 5): returns of slices in space that earlier slices saw as free.
class MovingInDepth {
 public:
  MovingInDepth();
  /// Makes the beams of such returns unknown; returns how many. `world_from_robot` may be in any level frame in which poses seldom jump.
  int leaveOut(RangeFan& slice, const Pose3& world_from_robot);

 private:
  FreeSpaceMemory memory_;
};

}  // namespace roomgraph
