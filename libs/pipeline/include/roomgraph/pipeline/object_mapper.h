// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <vector>

#include "roomgraph/pipeline/key_poses.h"
#include "roomgraph/pipeline/stages.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// A camera frame with its place in the map.
struct PosedFrame {
  const Frame& frame;
  Pose3 world_from_robot;
  const KeyPose& node;    ///< key pose that sightings are attached to
  Pose3 node_from_robot;  ///< movement from it
};

/// Selected measurements -> world -> association -> landmarks; the object part of one step (method.md sec. 4,
/// E-step). Appends the sightings for the factor graph.
std::vector<ObjectDecision> mapObjects(const std::vector<ObjectMeasurement>& measurements,
                                       const PosedFrame& posed, double pose_sigma_m, Associator& associator,
                                       LandmarkMap& landmarks, std::vector<LandmarkFactor>& sightings);

/// Lowers the existence of landmarks in good view where nothing was detected.
void missUnseen(const std::vector<ObjectDecision>& decisions, const std::vector<Detection>& detections,
                const PosedFrame& posed, LandmarkMap& landmarks);

}  // namespace roomgraph
