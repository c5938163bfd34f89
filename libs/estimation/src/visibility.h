// SPDX-License-Identifier: BSD-3-Clause
// Expected visibility of landmarks in a frame, and evidence of lidar beams about them.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Depth along the optical axis at a pixel (u, v), m; 0 where nothing was measured.
using DepthLookup = std::function<double(double u, double v)>;

/// The box of a landmark in good view: well inside the image, near and large enough, not hidden behind
/// something that the depth image shows in front of it. Nothing otherwise.
std::optional<Box2> boxInGoodView(const Landmark& landmark, const Pose3& camera_from_world,
                                  const PinholeCamera& camera, const DepthLookup& depth_at);

/// Whether a landmark is a miss in this frame: in good view, and without a detection at its position (one
/// with another label is a confusion, not a miss).
bool shouldBeSeen(const Landmark& landmark, const Frame& frame, const Pose3& world_from_camera,
                  const std::vector<Detection>& detections);

/// Whether the lidar sees so far; one whose range is not known (0) does.
bool reaches(const Scan& scan, double range_m);

/// Beams of a scan that are evidence for or against an object.
struct RayEvidence {
  int inside = 0;   ///< ended in its footprint
  int through = 0;  ///< passed through the middle of it and ended behind
};

/// Of an object of this shape at this place. `solid_share`: share of its height through which no beam passes
/// (ObjectModel::solid_share). Beams above it pass over the seat of a sofa, between the legs of a chair or through an
/// open door: they count only when they end inside.
RayEvidence rayEvidence(const ObjectShape& shape, const Pose3& world_from_object, const Scan& scan,
                        const Pose3& world_from_robot, double solid_share);

}  // namespace roomgraph
