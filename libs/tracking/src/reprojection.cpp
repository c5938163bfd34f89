// SPDX-License-Identifier: BSD-3-Clause
// Observation noise by pyramid level and depth, and the analytic reprojection Jacobian.
#include "reprojection.h"

#include <cmath>

#include "roomgraph/geometry/cross_matrix.h"

namespace roomgraph::tracking {

Observation makeObservation(const Eigen::Vector2d& pixel, int octave, double depth,
                            const TrackingParameters& parameters) {
  return {pixel, parameters.pixel_sigma_px * std::pow(parameters.scale_factor, octave), depth,
          parameters.depth_sigma_base_m + parameters.depth_sigma_quadratic * depth * depth};
}

Eigen::Matrix<double, 3, 6> reprojectionJacobian(const PinholeCamera& camera, const Observation& observation,
                                                 const Eigen::Vector3d& point) {
  const double iz = 1 / point.z(), s = 1 / observation.pixel_sigma;
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
  by_point(0, 0) = s * camera.fx * iz;
  by_point(0, 2) = -s * camera.fx * point.x() * iz * iz;
  by_point(1, 1) = s * camera.fy * iz;
  by_point(1, 2) = -s * camera.fy * point.y() * iz * iz;
  if (observation.depth > 0) by_point(2, 2) = 1 / observation.depth_sigma;
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << by_point, -by_point * crossing(point);
  return jacobian;
}

Pose3 leftPerturbation(const Vector6d& delta) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3(delta.tail<3>());
  pose.translation() = delta.head<3>();
  return pose;
}

}  // namespace roomgraph::tracking
