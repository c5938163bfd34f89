// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// Whether the detector ought to have found a landmark in this frame: well inside the image, near and large enough,
/// and not hidden behind something that the depth image shows in front of it.
bool shouldBeSeen(const Landmark& landmark, const Frame& frame, const Pose3& world_from_camera);

}  // namespace roomgraph
