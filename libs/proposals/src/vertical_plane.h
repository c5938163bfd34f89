// SPDX-License-Identifier: BSD-3-Clause
// Vertical plane through footprint points, with uncertainty.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace roomgraph {

/// Vertical plane as a line in the ground frame: normal . p = offset, unit normal towards the camera
/// (offset <= 0).
struct VerticalPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0;        ///< m
  double middle = 0;        ///< m, mean of the points, as a coordinate along the line
  double sigma_m = 0;       ///< of the offset, at the points' middle
  double sigma_rad = 0;     ///< of the normal's direction
  double inlier_share = 0;  ///< of the points

  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
};

/// Plane through two points of the ground.
VerticalPlane planeThrough(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Whether a point of the ground, measured by a depth camera above the origin, may lie on the plane.
bool isInlier(const VerticalPlane& plane, const Eigen::Vector2d& point);

/// Plane with the most inliers among the points (ground frame, measured from above the origin by a depth camera):
/// RANSAC over pairs with a fixed seed, then weighted total least squares. Depth errors are along the view, hence small
/// across a wall seen at a glancing angle. Nothing when there are few points, or about two thirds are outliers.
std::optional<VerticalPlane> fitVerticalPlane(const std::vector<Eigen::Vector2d>& points);

}  // namespace roomgraph
