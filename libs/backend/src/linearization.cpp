// SPDX-License-Identifier: BSD-3-Clause
// Sparse Jacobian and residuals of a FactorGraph at its current estimate.
#include "graph_state.h"
#include "solve.h"

namespace roomgraph {

std::vector<double*> FactorGraph::Impl::variableBlocks() {
  std::vector<double*> blocks;
  const auto add = [&](double* block) {
    if (!problem->IsParameterBlockConstant(block)) blocks.push_back(block);
  };
  for (auto& [id, pose] : poses) {
    add(pose.t.data());
    add(pose.q.data());
  }
  for (auto& [id, object] : objects) {
    add(object.value.data());
    add(object.size.data());
  }
  for (auto& [id, point] : points) add(point.value.data());
  return blocks;
}

std::optional<Linearization> FactorGraph::Impl::linearize(
    const std::vector<double*>& blocks, const std::vector<ceres::ResidualBlockId>& residual_blocks) const {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  options.residual_blocks = residual_blocks;
  options.num_threads = 1;
  std::vector<double> residuals;
  ceres::CRSMatrix rows;
  if (!evaluate(*problem, options, nullptr, &residuals, &rows)) return std::nullopt;
  Linearization out;
  out.residuals = Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
  out.jacobian = Eigen::Map<Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  return out;
}

}  // namespace roomgraph
