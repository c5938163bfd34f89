// SPDX-License-Identifier: BSD-3-Clause
// Segmentation of a detected object's depth points from background and occluders.
#pragma once

#include <vector>

#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// All points inside the box (slightly shrunk), and inside the detection's mask when it has one. At most
/// about `max_points`, on a regular pixel grid.
DepthMask sampleBox(const Frame& frame, const Detection& detection, const Pose3& ground_from_camera,
                    int max_points = 800);

/// Points left and right of the box and above it. At most about `max_points`, on a regular pixel grid.
DepthMask sampleAround(const Frame& frame, const Box2& box, const Pose3& ground_from_camera,
                       int max_points = 800);

/// What is around a box, above the ground, beyond the errors of the box's sides.
struct Surroundings {
  std::vector<MaskPoint> points;
  double width_px = 0;  ///< of the ring they are in, and of what is left out between it and the box
};

/// At most about `max_points`, on a regular pixel grid.
Surroundings sampleRing(const Frame& frame, const Box2& box, const Pose3& ground_from_camera, int max_points = 800);

/// Removes the ground and points higher than the class can be, clusters the rest (Euclidean distance) and returns the
/// clusters that explain the box best (large, central, filling the box, not behind others, not going on beyond it), best
/// first, at most `max_count`. When the first is an occluder, the object is the next. Parts of the object separated from its cluster
/// (a seat above a thin leg) are added to it when they lie within the usual size.
std::vector<DepthMask> explanations(const DepthMask& all, const Surroundings& ring, const Box2& box,
                                    const ObjectModel& model, double focal_px, int max_count);

}  // namespace roomgraph
