// SPDX-License-Identifier: BSD-3-Clause
// Interface of ground plane detection: the floor in one frame.
#pragma once

#include <optional>

#include "roomgraph/core/outcome.h"
#include "roomgraph/core/stage.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Depth image -> ground plane (method.md sec. 1.2).
class GroundDetector : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(GroundDetector)
 public:
  /// The floor measured in the frame, normal up, camera frame; or why there is none. `expected`: plane predicted
  /// from the extrinsics or from the frames before, camera frame; nothing when unknown (a handheld camera that has not
  /// seen the floor yet).
  virtual Outcome<GroundEstimate> detect(const Frame& frame, const std::optional<Plane>& expected) = 0;
};

/// The ground of a frame: measured by the detector; else the expected one, with a small fixed covariance; else none.
FrameGround groundOf(const Frame& frame, const std::optional<Plane>& expected, GroundDetector& detector);

}  // namespace roomgraph
