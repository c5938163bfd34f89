// SPDX-License-Identifier: BSD-3-Clause
// Least-squares scan-to-grid refinement with a pose prior, and its covariance.
#pragma once

#include "probability_grid.h"

namespace roomgraph {

/// Gaussian prior on the pose, as weights relative to the scan's residual.
struct PosePrior {
  Pose2 pose;
  double weight_per_m2 = 0, weight_per_rad2 = 0;  ///< against the mean squared residual (1 - p) of the points
  /// Additional weight by direction; x, y only.
  Eigen::Matrix2d extra_weight_per_m2 = Eigen::Matrix2d::Zero();
  /// Inverse covariance of x, y where it is known: on surfaces, whose lines have one, too. Not used on grids.
  Eigen::Matrix2d information_per_m2 = Eigen::Matrix2d::Zero();
  bool may_slip = false;  ///< it counts less the more the scan contradicts it
};

struct GridRefinement {
  Pose2 grid_from_scan;
  /// Of the summed squared residuals by (x, y, yaw) of the pose: directions from the surfaces
  /// (surfaceCurvature), size from the grid; the prior is not in it.
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mean_curvature = Eigen::Matrix3d::Zero();  ///< of the grid itself, by the mean squared residual
  double residual_variance = 1;  ///< mean of (1 - p)^2
  double explained = 0;          ///< share of the points on a surface of the grid
  double contradicted = 0;       ///< share of the points in space the grid knows to be free
  double trust = 1;              ///< share of the prior's information_per_m2 that counted
  bool on_surfaces = false;      ///< refined further, and its curvature is that of refineOnSurfaces()
};

/// Cost of a pose: mean over the points of (1 - p)^2, plus the prior; with its gradient by (x, y, yaw) and
/// the Gauss-Newton curvature of the mean.
struct GridCost {
  double value = 0, residual = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
};
GridCost gridCost(const ProbabilityGrid& grid, const Points2& points, const Pose2& grid_from_scan,
                  const PosePrior& prior);

/// Mean over the points of J^T N J, J the derivative of the point by (x, y, yaw) of the pose and N the
/// projection on the normal of the surface around it (closer to isotropic the less its neighbours form a line, zero
/// for an isolated point). Unlike the grid's own Gauss-Newton matrix it is not affected by the
/// discretisation into cells, which looks like a constraint along a corridor. Scaled so that its trace in
/// (x, y) is that of `grid_curvature`.
Eigen::Matrix3d surfaceCurvature(const Points2& points, const Pose2& grid_from_scan,
                                 const Eigen::Matrix3d& grid_curvature);

/// Of x and y whatever the yaw: the Schur complement.
Eigen::Matrix2d placeCurvature(const Eigen::Matrix3d& curvature);

/// Levenberg-Marquardt on the interpolated grid (Hess et al. 2016, Eq. CS) with a prior on the pose.
GridRefinement refineOnGrid(const ProbabilityGrid& grid, const Points2& points, const Pose2& start,
                            const PosePrior& prior, int max_iterations = 20);

/// Covariance of a refined pose, in the grid's axes: residual_variance * curvature^-1, bounded by `max_sigma`
/// (m and rad) along what the scan does not fix, plus the floor's squares.
struct CovarianceModel {
  double inflation = 1;  ///< of the standard deviations: residuals are correlated
  double floor_sigma_m = 0.005, floor_sigma_rad = 0.002;
  double max_sigma = 1;
};
Eigen::Matrix3d poseCovariance(const GridRefinement& refinement, const CovarianceModel& model);

}  // namespace roomgraph
