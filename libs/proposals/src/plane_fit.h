// SPDX-License-Identifier: BSD-3-Clause
// Plane fitting: RANSAC hypothesis and robust refinement with covariance.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "roomgraph/geometry/ground.h"

namespace roomgraph {

/// Axial standard deviation of a Kinect's depth measurement, m (Nguyen, Izadi and Lovell 2012).
double depthSigma(double z_m);
/// Roughness of floors and walls, added to it, m.
inline constexpr double kSurfaceNoise_m = 0.004;

/// Plane through three points, normal turned towards the camera centre (origin); nothing when they are
/// collinear.
std::optional<Plane> planeThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c);

/// Plane that maximises inliers(plane) over `tries` random triples among the points, fixed seed. `inliers`
/// returns 0 for a plane that is not acceptable.
std::optional<Plane> bestPlane(const std::vector<Eigen::Vector3d>& points, int tries,
                               const std::function<int(const Plane&)>& inliers);

/// Plane refined on the points near it by iteratively re-weighted least squares, with the covariance of
/// (normal, offset).
struct RefinedPlane {
  Plane plane;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  int inliers = 0;
  double spread_m = 0;  ///< smaller standard deviation of the inliers within the plane
};
RefinedPlane refinePlane(const Plane& initial, const std::vector<Eigen::Vector3d>& points);

}  // namespace roomgraph
