// SPDX-License-Identifier: BSD-3-Clause
// Bundle adjustment of a few poses and many points by the Schur complement.
#pragma once

#include <vector>

#include "reprojection.h"

namespace roomgraph::tracking {

/// What one camera says about one point.
struct BundleTerm {
  int camera = 0;
  Observation observation;
};

/// A camera that sees points.
struct BundleCamera {
  PinholeCamera intrinsics;
  Pose3 camera_from_odom = Pose3::Identity();
  bool moves = true;  ///< else its pose is given
};

/// A point and who sees it; no camera twice.
struct BundlePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< odom frame, m
  std::vector<BundleTerm> terms;
};

struct SparseBundle {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePoint> points;
};

struct BundleOptions {
  int max_iterations = 6;    ///< linear systems that are solved
  double huber = 2;          ///< of the norm of a term's whitened residual (u, v, z), sigma
  double tolerance = 1e-4;   ///< relative change of the cost at which it ends
};

/// Half the sum of the robust squared residuals, Huber's rho; infinite when a point lies behind a camera that sees it.
double costOf(const SparseBundle& bundle, double huber);

/// Minimises the cost over the poses that move and all points, by Levenberg's and Marquardt's method; the points are
/// eliminated (Triggs et al., Bundle Adjustment - A Modern Synthesis, 2000, sec. 6.1). The cost never grows. False, with
/// nothing changed, when it is infinite to begin with.
bool adjust(SparseBundle& bundle, const BundleOptions& options);

}  // namespace roomgraph::tracking
