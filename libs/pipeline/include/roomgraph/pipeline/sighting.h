// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <vector>

#include "roomgraph/observations/landmark.h"
#include "roomgraph/pipeline/key_poses.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Factor between a key pose and the landmark a measurement was given to; weight = association probability x
/// selection confidence x initialisation score (method.md sec. 4). A yaw that looks the other way than the
/// landmark's is turned round: front and back of an object are easily confused, its direction is not.
LandmarkFactor sightingOf(const ObjectDecision& decision, const Landmark& landmark, const KeyPose& node,
                          const Pose3& node_from_camera);

/// Weighted mean of sightings of one landmark from one key pose; covariance and weight are those of a single
/// one of them. At least one sighting.
LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings);

}  // namespace roomgraph
