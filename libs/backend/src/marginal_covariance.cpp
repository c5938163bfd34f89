// SPDX-License-Identifier: BSD-3-Clause
// Marginal covariances of landmarks from the decomposed information matrix.
#include <Eigen/CholmodSupport>
#include <numbers>
#include <unordered_map>

#include "graph_state.h"
#include "solve.h"

namespace roomgraph {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kUniformYaw = std::numbers::pi * std::numbers::pi / 3;  // variance over the circle
constexpr double kSmallestPivot = 1e-12;  // of a matrix with a diagonal of ones, against the largest

// Says whether what it decomposed is far enough from singular, and survives want of memory.
class Cholesky : public Eigen::CholmodSupernodalLLT<Sparse> {
 public:
  bool decompose(const Sparse& information) {
    cholmod().print = 0;  // the result says what is wrong
    analyzePattern(information);
    if (!m_cholmodFactor) return false;
    factorize(information);
    return info() == Eigen::Success && cholmod_rcond(m_cholmodFactor, &cholmod()) > kSmallestPivot;
  }
};

Eigen::VectorXd squaredNorms(const Sparse& columns) {
  Eigen::VectorXd out(columns.cols());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) out[j] = columns.col(j).squaredNorm();
  return out;
}

// Decomposed information matrix of all variables; blocks of its inverse are computed column by column.
class Covariances {
 public:
  explicit Covariances(FactorGraph::Impl& graph) {
    const std::vector<double*> blocks = graph.variableBlocks();
    for (const double* block : blocks) {
      places_[block] = {size_, graph.freedoms(block)};
      size_ += graph.freedoms(block);
    }
    if (blocks.empty()) return;
    if (auto linear = graph.linearize(blocks, {})) decompose(std::move(linear->jacobian));
  }

  bool ok() const { return ok_; }

  /// Marginal covariance of a variable block along its tangent.
  Eigen::MatrixXd of(const double* block) const {
    const auto [first, count] = places_.at(block);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size_, count);
    for (int j = 0; j < count; ++j) right(first + j, j) = 1;
    const Eigen::MatrixXd columns = solver_.solve(right);
    Eigen::MatrixXd out(count, count);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const int r = first + i, c = first + j;
        out(i, j) = scale_[r] * scale_[c] * columns(r, j);
      }
    return (out + out.transpose()) / 2;
  }

 private:
  // Scaled to a diagonal of ones, so that the units do not decide what counts as singular. Only the lower triangle, and
  // nothing that is done with: in a long run this is the largest matrix.
  void decompose(Sparse jacobian) {
    const Eigen::VectorXd diagonal = squaredNorms(jacobian);
    if (!diagonal.allFinite() || diagonal.minCoeff() <= 0) return;
    scale_ = diagonal.cwiseSqrt().cwiseInverse();
    jacobian = jacobian * scale_.asDiagonal();
    Sparse information(size_, size_);
    information.selfadjointView<Eigen::Lower>().rankUpdate(Sparse(jacobian.transpose()));
    jacobian = Sparse();
    ok_ = solver_.decompose(information);
  }

  std::unordered_map<const double*, std::pair<int, int>> places_;  // block: first row, rows
  int size_ = 0;
  Eigen::VectorXd scale_;
  Cholesky solver_;
  bool ok_ = false;
};

Eigen::Matrix4d landmarkBlock(const Covariances& covariances, const FactorGraph::Impl::Object& object) {
  Eigen::Matrix4d out = Eigen::Matrix4d::Zero();
  const Eigen::MatrixXd block = covariances.of(object.value.data());
  out.topLeftCorner(block.rows(), block.cols()) = block;
  if (!object.free_yaw) out(3, 3) = kUniformYaw;
  return out;
}

}  // namespace

std::optional<std::map<LandmarkId, Eigen::Matrix4d>> FactorGraph::landmarkCovariances() const {
  std::vector<LandmarkId> all;
  for (const auto& [id, object] : impl_->objects) all.push_back(id);
  return landmarkCovariances(all);
}

std::optional<std::map<LandmarkId, Eigen::Matrix4d>> FactorGraph::landmarkCovariances(
    const std::vector<LandmarkId>& of) const {
  if (impl_->objects.empty()) return std::nullopt;
  const SerialCholmod serial;
  const Covariances covariances(*impl_);
  if (!covariances.ok()) return std::nullopt;
  std::map<LandmarkId, Eigen::Matrix4d> result;
  for (const LandmarkId id : of)
    if (const auto found = impl_->objects.find(id); found != impl_->objects.end())
      result[id] = landmarkBlock(covariances, found->second);
  return result;
}

}  // namespace roomgraph
