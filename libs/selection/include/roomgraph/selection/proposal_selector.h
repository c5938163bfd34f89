// SPDX-License-Identifier: BSD-3-Clause
// Interface of proposal selection: at most one measurement per detection.
#pragma once

#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/observations/feature_track.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Camera, pose and features of a frame, beside its detections.
struct FrameContext {
  PinholeCamera camera;
  Pose3 world_from_camera = Pose3::Identity();  ///< best estimate at this time
  std::vector<FeatureTrack> features;           ///< tracked features; empty when tracking is off or lost
};

/// Chooses among the proposals of each detection (method.md sec. 3).
class ProposalSelector : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ProposalSelector)
 public:
  /// At most one measurement per detection. Frames come in order of time; implementations may remember those
  /// of a window.
  virtual std::vector<ObjectMeasurement> select(const FrameProposals& frame, const FrameContext& context) = 0;
};

}  // namespace roomgraph
