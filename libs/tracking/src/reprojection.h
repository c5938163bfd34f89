// SPDX-License-Identifier: BSD-3-Clause
// Reprojection residual with depth, its Jacobian and noise model.
#pragma once

#include <Eigen/Core>

#include "roomgraph/geometry/camera.h"
#include "roomgraph/geometry/pose.h"
#include "tracking_parameters.h"

namespace roomgraph::tracking {

/// What one image says about one point: pixel, and depth when there is one.
struct Observation {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double pixel_sigma = 1;  ///< px
  double depth = 0;        ///< m, 0: none
  double depth_sigma = 1;  ///< m
};

/// Observation with the noise of its pyramid level and the depth noise sigma_z = base + quadratic z^2
/// (Khoshelham & Elberink, Sensors 2012).
Observation makeObservation(const Eigen::Vector2d& pixel, int octave, double depth,
                            const TrackingParameters& parameters);

/// Whitened residuals (u, v, z) of a point in the camera frame, z > 0; the third is 0 without a depth.
template <class T>
void reprojectionResidual(const PinholeCamera& camera, const Observation& observation, const T* point,
                          T* residual) {
  residual[0] =
      (camera.fx * point[0] / point[2] + camera.cx - observation.pixel.x()) / observation.pixel_sigma;
  residual[1] =
      (camera.fy * point[1] / point[2] + camera.cy - observation.pixel.y()) / observation.pixel_sigma;
  residual[2] = observation.depth > 0 ? (point[2] - observation.depth) / observation.depth_sigma : T(0);
}

/// Derivative of the residuals by a perturbation (translation, rotation) of camera_from_world on the left:
/// p <- p + translation + rotation x p.
Eigen::Matrix<double, 3, 6> reprojectionJacobian(const PinholeCamera& camera, const Observation& observation,
                                                 const Eigen::Vector3d& point);

/// exp of such a perturbation: rotation vector, then translation added.
Pose3 leftPerturbation(const Vector6d& delta);

}  // namespace roomgraph::tracking
