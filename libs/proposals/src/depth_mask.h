// SPDX-License-Identifier: BSD-3-Clause
// Depth points of a detected object, segmented from background and occluders.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// A depth measurement inside a detection's box.
struct MaskPoint {
  double u = 0, v = 0;        ///< px
  Eigen::Vector3d in_ground;  ///< m, ground frame (geometry/ground.h)
};

/// Depth points that belong to a detected object (method.md sec. 1.3).
struct DepthMask {
  std::vector<MaskPoint> points;  ///< empty: no depth, or nothing that could be the object
  double valid_ratio = 0;         ///< share of the box's (mask's) pixels that have a depth
};

/// All points inside the box (slightly shrunk), and inside the detection's mask when it has one. At most
/// about `max_points`, on a regular pixel grid.
DepthMask sampleBox(const Frame& frame, const Detection& detection, const Pose3& ground_from_camera,
                    int max_points = 800);

/// Removes the ground and what is higher than the class can be, clusters the rest (Euclidean distance) and
/// keeps the cluster that explains the box best: large, central, filling the box, not behind others; parts of
/// the object that are apart from it (a seat above a thin leg) are taken in when they lie within the nominal
/// size.
DepthMask explainBox(const DepthMask& all, const Box2& box, const ObjectModel& model, double focal_px);

/// The clusters that explain the box, best first, at most `max_count`: when an occluder was taken for the
/// object, the object is the next.
std::vector<DepthMask> explanations(const DepthMask& all, const Box2& box, const ObjectModel& model,
                                    double focal_px, int max_count);

}  // namespace roomgraph
