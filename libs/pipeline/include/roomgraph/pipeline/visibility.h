// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <vector>

#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// Whether the detector ought to have found a landmark in this frame and did not: well inside the image, near
/// and large enough, not hidden behind something that the depth image shows in front of it, and no detection
/// where it stands (one with another label is a confusion, not a miss).
bool shouldBeSeen(const Landmark& landmark, const Frame& frame, const Pose3& world_from_camera,
                  const std::vector<Detection>& detections);

}  // namespace roomgraph
