// SPDX-License-Identifier: BSD-3-Clause
// Marginalisation by square-root Schur complement: a prior on the kept variables.
#include <Eigen/QR>
#include <algorithm>
#include <set>

#include "graph_state.h"
#include "marginal_prior_cost.h"

namespace roomgraph {
namespace {

using Impl = FactorGraph::Impl;

// Parameter blocks of some kept variables, and the columns of their tangents in a prior.
struct Columns {
  std::vector<double*> blocks;  // variable ones only
  std::vector<int> target;      // column of the prior, per tangent of `blocks`
  std::vector<double> scale;    // derivative of the solver's tangent with respect to the prior's
  int size = 0;                 // of the prior

  void add(const Impl& graph, double* block, int offset, double factor = 1) {
    if (graph.problem->IsParameterBlockConstant(block)) return;
    blocks.push_back(block);
    for (int i = 0; i < graph.freedoms(block); ++i) {
      target.push_back(size + offset + i);
      scale.push_back(factor);
    }
  }
};

struct Absorbed {
  std::vector<ceres::ResidualBlockId> factors;
  std::set<const double*> touched;
};

std::set<const double*> blocksOf(Impl& graph, const Variables& keep) {
  std::set<const double*> blocks;
  for (const NodeId id : keep.nodes) blocks.insert({graph.at(id).t.data(), graph.at(id).q.data()});
  for (const LandmarkId id : keep.landmarks)
    blocks.insert({graph.at(id).value.data(), graph.at(id).size.data()});
  for (const PointId id : keep.points) blocks.insert(graph.at(id).value.data());
  return blocks;
}

Absorbed absorb(const Impl& graph, const std::set<const double*>& kept) {
  Absorbed out;
  for (const auto& entry : graph.factors) {
    std::vector<double*> blocks;
    graph.problem->GetParameterBlocksForResidualBlock(entry.block, &blocks);
    const bool leaves =
        std::any_of(blocks.begin(), blocks.end(), [&](double* b) { return !kept.contains(b); });
    if (!leaves && !std::holds_alternative<MarginalPrior>(entry.factor)) continue;
    out.factors.push_back(entry.block);
    out.touched.insert(blocks.begin(), blocks.end());
  }
  return out;
}

std::vector<double*> removedBlocks(Impl& graph, const Absorbed& absorbed,
                                   const std::set<const double*>& kept) {
  std::vector<double*> out;
  for (double* block : graph.variableBlocks())
    if (absorbed.touched.contains(block) && !kept.contains(block)) out.push_back(block);
  return out;
}

// Ids, estimates and columns of the kept variables of the absorbed factors.
Columns separators(const FactorGraph& graph, Impl& state, const Variables& keep,
                   const std::set<const double*>& touched, MarginalPrior& prior) {
  Columns columns;
  for (const NodeId id : keep.nodes) {
    auto& pose = state.at(id);
    if (pose.fixed || !touched.contains(pose.t.data())) continue;
    prior.variables.nodes.push_back(id);
    prior.poses.push_back(graph.pose(id));
    columns.add(state, pose.t.data(), 0);
    columns.add(state, pose.q.data(), 3, 0.5);
    columns.size += kPoseTangent;
  }
  for (const LandmarkId id : keep.landmarks) {
    auto& object = state.at(id);
    if (!touched.contains(object.value.data()) && !touched.contains(object.size.data())) continue;
    prior.variables.landmarks.push_back(id);
    prior.landmarks.push_back(graph.landmark(id));
    columns.add(state, object.value.data(), 0);
    columns.add(state, object.size.data(), 4);
    columns.size += kLandmarkTangent;
  }
  for (const PointId id : keep.points) {
    auto& point = state.at(id);
    if (!touched.contains(point.value.data())) continue;
    prior.variables.points.push_back(id);
    prior.points.push_back(graph.point(id));
    columns.add(state, point.value.data(), 0);
    columns.size += kPointTangent;
  }
  return columns;
}

// Schur complement in square-root form (Demmel et al., CVPR 2021): the rows of Qᵀ [kept, residuals] that are zero
// in the removed columns. Also valid for removed directions that nothing measures.
Eigen::MatrixXd withoutRemoved(const Eigen::MatrixXd& removed, const Eigen::MatrixXd& kept) {
  if (removed.cols() == 0) return kept;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(removed.rows(), removed.cols());
  qr.setThreshold(1e-12);
  qr.compute(removed);
  const Eigen::MatrixXd rotated = qr.householderQ().transpose() * kept;
  return rotated.bottomRows(rotated.rows() - qr.rank());
}

// Reduces the system to as many rows as columns. The last column is the residual; its rest is a constant cost.
Eigen::MatrixXd compressed(const Eigen::MatrixXd& system) {
  if (system.rows() < system.cols()) return system;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system);
  const Eigen::MatrixXd r = qr.matrixQR().triangularView<Eigen::Upper>();
  return r.topRows(system.cols() - 1);
}

}  // namespace

std::optional<MarginalPrior> FactorGraph::marginalize(const Variables& keep) const {
  const auto kept = blocksOf(*impl_, keep);
  const Absorbed absorbed = absorb(*impl_, kept);
  if (absorbed.factors.empty()) return std::nullopt;
  MarginalPrior prior;
  const Columns columns = separators(*this, *impl_, keep, absorbed.touched, prior);
  if (columns.blocks.empty()) return std::nullopt;
  std::vector<double*> blocks = removedBlocks(*impl_, absorbed, kept);
  Eigen::Index removed = 0;
  for (const double* block : blocks) removed += impl_->freedoms(block);
  blocks.insert(blocks.end(), columns.blocks.begin(), columns.blocks.end());
  const auto linear = impl_->linearize(blocks, absorbed.factors);
  if (!linear) return std::nullopt;
  Eigen::MatrixXd system(linear->jacobian.rows(), linear->jacobian.cols() + 1);
  system << Eigen::MatrixXd(linear->jacobian), linear->residuals;
  const Eigen::MatrixXd left =
      compressed(withoutRemoved(system.leftCols(removed), system.rightCols(system.cols() - removed)));
  const Eigen::Index separate = left.cols() - 1;
  if (left.rows() == 0 || left.leftCols(separate).isZero(0)) return std::nullopt;
  prior.root = Eigen::MatrixXd::Zero(left.rows(), columns.size);
  for (Eigen::Index j = 0; j < separate; ++j) {
    const auto i = static_cast<std::size_t>(j);
    prior.root.col(columns.target[i]) = columns.scale[i] * left.col(j);
  }
  prior.offset = left.col(separate);
  return prior;
}

}  // namespace roomgraph
