// SPDX-License-Identifier: BSD-3-Clause
// What tracking found of a frame that did not become a keyframe, as bytes and back.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "feature_extractor.h"
#include "pose_solver.h"

namespace roomgraph::tracking {

/// A located frame, as far as the tracker's state and later stages depend on it.
struct LocatedView {
  Features features;                  ///< those that show a point: pixel and depth
  std::vector<std::int64_t> points;   ///< ids of these
  std::vector<std::int64_t> in_view;  ///< points that were predicted to be seen
  Pose3 odom_from_camera = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the pose, as PoseSolution has it
  int inliers = 0, matches = 0;
  int reference = -1, reference_inliers = 0;  ///< the tracker's, once the frame was located
};

std::string bytesOf(const LocatedView& view);
/// What bytesOf() was given. Throws std::exception when they are no view.
LocatedView locatedView(const std::string& bytes);

}  // namespace roomgraph::tracking
