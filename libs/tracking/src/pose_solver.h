// SPDX-License-Identifier: BSD-3-Clause
// Camera pose from known points: refinement and RANSAC PnP.
#pragma once

#include <optional>
#include <vector>

#include "reprojection.h"

namespace roomgraph::tracking {

/// Where the camera should be, by what the image does not say; errors are independent and alike in all directions.
struct PosePrior {
  Pose3 camera_from_world = Pose3::Identity();
  double sigma_m = 1, sigma_rad = 1;

  Vector6d sigmas() const;
  /// How far another pose is from it in standard deviations, as the argument of leftPerturbation.
  Vector6d deviation(const Pose3& other_from_world) const;
};

/// Points with known places and what the image says about them; both lists have the same length.
struct PoseProblem {
  PinholeCamera camera;
  std::vector<Eigen::Vector3d> points;  ///< world, m
  std::vector<Observation> observations;
  std::optional<PosePrior> prior{};  ///< counts as one more measurement
};

struct PoseSolution {
  Pose3 camera_from_world = Pose3::Identity();
  std::vector<char> inlier;  ///< per observation, judged by its pixel
  int inliers = 0;
  Matrix6d covariance =
      Matrix6d::Identity();  ///< of leftPerturbation (translation, rotation) in the camera frame
};

/// How far a solution is from where it was said to be, in standard deviations of both.
double deviationFrom(const PosePrior& prior, const PoseSolution& solution);

/// Motion-only refinement: Levenberg-Marquardt on robust pixel and depth residuals, outliers re-classified
/// between rounds. `start_is_good`: outliers are told by the given pose already before the first round.
PoseSolution refinePose(const PoseProblem& problem, const Pose3& camera_from_world,
                        bool start_is_good = false);

/// Squared residual of each pixel in standard deviations; infinite where the depth is of another surface, or the point behind the camera.
std::vector<double> pixelErrors(const PoseProblem& problem, const Pose3& camera_from_world);

/// Whether such an error is within those of 95 % of right matches.
bool agrees(double squared_error);

/// PnP in RANSAC, then refinement; no start needed. Inliers 0 when none was found.
PoseSolution ransacPose(const PoseProblem& problem, int min_inliers);

}  // namespace roomgraph::tracking
