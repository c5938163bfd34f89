// SPDX-License-Identifier: BSD-3-Clause
// Camera pose from known points: refinement and RANSAC PnP.
#pragma once

#include <vector>

#include "reprojection.h"

namespace roomgraph::tracking {

/// Points with known places and what the image says about them; both lists have the same length.
struct PoseProblem {
  PinholeCamera camera;
  std::vector<Eigen::Vector3d> points;  ///< world, m
  std::vector<Observation> observations;
};

struct PoseSolution {
  Pose3 camera_from_world = Pose3::Identity();
  std::vector<char> inlier;  ///< per observation, judged by its pixel
  int inliers = 0;
  Matrix6d covariance =
      Matrix6d::Identity();  ///< of leftPerturbation (translation, rotation) in the camera frame
};

/// Motion-only refinement: Levenberg-Marquardt on robust pixel and depth residuals, outliers re-classified
/// between rounds. `start_is_good`: outliers are told by the given pose already before the first round.
PoseSolution refinePose(const PoseProblem& problem, const Pose3& camera_from_world,
                        bool start_is_good = false);

/// PnP in RANSAC, then refinement; no start needed. Inliers 0 when none was found.
PoseSolution ransacPose(const PoseProblem& problem, int min_inliers);

}  // namespace roomgraph::tracking
