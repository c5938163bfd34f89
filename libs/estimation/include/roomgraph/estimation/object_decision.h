// SPDX-License-Identifier: BSD-3-Clause
// One object measurement with the landmark it was given to, and all those of one frame.
#pragma once

#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/association/former_sighting.h"
#include "roomgraph/observations/feature_track.h"

namespace roomgraph {

/// One selected measurement and the landmark it was given to.
struct ObjectDecision {
  WorldMeasurement seen;
  Association association;
  LandmarkId landmark;  ///< the landmark it was fused into (a new one's id when it was made)
};

/// The objects measured in one frame, as a run remembers them.
struct ObjectFrame {
  FrameId frame;
  double t = 0;
  PinholeCamera camera;
  Pose3 robot_from_camera = Pose3::Identity();
  std::vector<ObjectDecision> decisions;  ///< positions in world as of the last E-step
  std::vector<FeatureTrack> features;     ///< some with depth that lie on the objects
};

}  // namespace roomgraph
