// SPDX-License-Identifier: BSD-3-Clause
// Marginal covariances of poses and landmarks from the decomposed information matrix.
#include <Eigen/SparseCholesky>
#include <numbers>
#include <unordered_map>

#include "graph_state.h"

namespace roomgraph {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kUniformYaw = std::numbers::pi * std::numbers::pi / 3;  // variance over the circle
constexpr double kSmallestPivot = 1e-12;  // of a matrix with a diagonal of ones

// The information matrix of everything variable, decomposed; blocks of its inverse column by column.
class Covariances {
 public:
  explicit Covariances(FactorGraph::Impl& graph) {
    const std::vector<double*> blocks = graph.variableBlocks();
    for (const double* block : blocks) {
      places_[block] = {size_, graph.freedoms(block)};
      size_ += graph.freedoms(block);
    }
    if (blocks.empty()) return;
    if (const auto linear = graph.linearize(blocks, {})) decompose(linear->jacobian);
  }

  bool ok() const { return ok_; }

  /// Joint covariance of some blocks along their tangents; a constant block has none.
  Eigen::MatrixXd joint(const std::vector<const double*>& blocks) const {
    std::vector<int> rows;
    for (const double* block : blocks)
      if (const auto found = places_.find(block); found != places_.end())
        for (int i = 0; i < found->second.second; ++i) rows.push_back(found->second.first + i);
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size_, count);
    for (Eigen::Index j = 0; j < count; ++j) right(rows[static_cast<std::size_t>(j)], j) = 1;
    const Eigen::MatrixXd columns = solver_.solve(right);
    Eigen::MatrixXd out(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) {
        const int r = rows[static_cast<std::size_t>(i)], c = rows[static_cast<std::size_t>(j)];
        out(i, j) = scale_[r] * scale_[c] * columns(r, j);
      }
    return (out + out.transpose()) / 2;
  }

 private:
  // Scaled to a diagonal of ones, so that metres, radians and pixels do not decide what counts as singular.
  void decompose(const Sparse& jacobian) {
    Sparse information = jacobian.transpose() * jacobian;
    const Eigen::VectorXd diagonal = information.diagonal();
    if (!diagonal.allFinite() || diagonal.minCoeff() <= 0) return;
    scale_ = diagonal.cwiseSqrt().cwiseInverse();
    information = scale_.asDiagonal() * information * scale_.asDiagonal();
    solver_.compute(information);
    ok_ = solver_.info() == Eigen::Success && solver_.vectorD().minCoeff() > kSmallestPivot;
  }

  std::unordered_map<const double*, std::pair<int, int>> places_;  // block: first row, rows
  int size_ = 0;
  Eigen::VectorXd scale_;
  Eigen::SimplicialLDLT<Sparse> solver_;
  bool ok_ = false;
};

// Tangents of the solver to those of the interface: a quaternion's is half a rotation vector; what is held
// has no rows.
Eigen::MatrixXd poseRows(const FactorGraph::Impl::Pose& pose) {
  if (pose.fixed) return Eigen::MatrixXd::Zero(6, 0);
  Matrix6d rows = Matrix6d::Identity();
  rows.bottomRightCorner<3, 3>() *= 2;
  return rows;
}

Eigen::Matrix4d landmarkBlock(const Covariances& covariances, const FactorGraph::Impl::Object& object) {
  Eigen::Matrix4d out = Eigen::Matrix4d::Zero();
  const Eigen::MatrixXd block = covariances.joint({object.value.data()});
  out.topLeftCorner(block.rows(), block.cols()) = block;
  if (!object.free_yaw) out(3, 3) = kUniformYaw;
  return out;
}

}  // namespace

std::optional<std::map<LandmarkId, Eigen::Matrix4d>> FactorGraph::landmarkCovariances() const {
  if (impl_->objects.empty()) return std::nullopt;
  const Covariances covariances(*impl_);
  if (!covariances.ok()) return std::nullopt;
  std::map<LandmarkId, Eigen::Matrix4d> result;
  for (const auto& [id, object] : impl_->objects) result[id] = landmarkBlock(covariances, object);
  return result;
}

std::optional<Matrix6d> FactorGraph::poseCovariance(NodeId id) const {
  const auto& pose = impl_->at(id);
  if (pose.fixed) return Matrix6d::Zero();
  const Covariances covariances(*impl_);
  if (!covariances.ok()) return std::nullopt;
  const Eigen::MatrixXd rows = poseRows(pose);
  return Matrix6d(rows * covariances.joint({pose.t.data(), pose.q.data()}) * rows.transpose());
}

std::optional<Matrix10d> FactorGraph::jointCovariance(NodeId node, LandmarkId landmark) const {
  const auto all = jointCovariances(node, {landmark});
  if (!all) return std::nullopt;
  return all->at(landmark);
}

std::optional<std::map<LandmarkId, Matrix10d>> FactorGraph::jointCovariances(
    NodeId node, const std::vector<LandmarkId>& landmarks) const {
  const auto& pose = impl_->at(node);
  for (const LandmarkId id : landmarks) impl_->at(id);
  const Covariances covariances(*impl_);
  if (!covariances.ok()) return std::nullopt;
  std::map<LandmarkId, Matrix10d> result;
  for (const LandmarkId id : landmarks) {
    const auto& object = impl_->at(id);
    const Eigen::MatrixXd of_pose = poseRows(pose);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(10, of_pose.cols() + (object.free_yaw ? 4 : 3));
    rows.topLeftCorner(6, of_pose.cols()) = of_pose;
    for (Eigen::Index i = of_pose.cols(); i < rows.cols(); ++i) rows(6 + i - of_pose.cols(), i) = 1;
    const auto block = covariances.joint({pose.t.data(), pose.q.data(), object.value.data()});
    Matrix10d& out = result[id] = rows * block * rows.transpose();
    if (!object.free_yaw) out(9, 9) = kUniformYaw;
  }
  return result;
}

}  // namespace roomgraph
