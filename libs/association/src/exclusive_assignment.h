// SPDX-License-Identifier: BSD-3-Clause
// Joint assignment of measurements to landmarks under mutual exclusion: exact marginals and maximum.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// Distribution over the joint assignments of one frame in which no landmark serves two measurements.
struct JointAssignment {
  Eigen::MatrixXd marginal;  ///< measurements x landmarks: probability that row takes column
  Eigen::VectorXd none;      ///< per measurement: probability that it takes no landmark
  std::vector<int> best;     ///< most probable joint assignment: column per measurement, -1: none
};

/// Exact marginals and maximum over all joint assignments (method.md sec. 4: two measurements of one frame
/// cannot take the same landmark). ratios(k, j) >= 0 is the weight of "measurement k is landmark j" over the
/// weight of "k is no landmark"; a joint assignment weighs the product of its ratios. Sums run over the
/// subsets of the smaller side of every connected component; beyond twelve on that side (never met in a
/// room) a component's weakest links are cut until it fits.
JointAssignment solveExclusive(const Eigen::MatrixXd& ratios);

}  // namespace roomgraph
