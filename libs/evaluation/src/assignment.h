// SPDX-License-Identifier: BSD-3-Clause
// Optimal one-to-one assignment of rows to columns within a gate.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// Optimal one-to-one assignment of rows to columns under a gate: as many pairs with cost <= gate as possible
/// and, among those choices, the least sum of costs (Hungarian method, O(n^3)). Costs are finite and >= 0.
/// Returns for each row its column, or -1.
std::vector<int> assignWithinGate(const Eigen::MatrixXd& costs, double gate);

}  // namespace roomgraph
