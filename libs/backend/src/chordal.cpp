// SPDX-License-Identifier: BSD-3-Clause
// Rotations, then translations, as sparse linear least squares with one pose held.
#include "chordal.h"

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

namespace roomgraph {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// Normal equations of sum weight |M x_a - x_b + c|^2 over the edges, x of N rows and 3 columns per node, the
// anchor's x given.
template <int N>
class LinearGraph {
 public:
  using Block = Eigen::Matrix<double, N, N>;
  using Value = Eigen::Matrix<double, N, 3>;

  LinearGraph(const std::map<NodeId, Pose3>& nodes, NodeId anchor, const Value& anchor_value)
      : anchor_value_(anchor_value) {
    for (const auto& [id, pose] : nodes) {
      if (id != anchor) index_.emplace(id, static_cast<int>(index_.size()));
    }
    right_.setZero(size(), 3);
  }

  void add(NodeId a, NodeId b, const Block& m, const Value& c, double weight) {
    const auto i = index_.find(a), j = index_.find(b);
    const bool free_a = i != index_.end(), free_b = j != index_.end();
    if (free_a) {
      put(i->second, i->second, weight * m.transpose() * m);
      at(i->second) -= weight * m.transpose() * (free_b ? c : Value(c - anchor_value_));
    }
    if (free_b) {
      put(j->second, j->second, weight * Block::Identity());
      at(j->second) += weight * (free_a ? c : Value(c + m * anchor_value_));
    }
    if (free_a && free_b) {
      put(i->second, j->second, -weight * m.transpose());
      put(j->second, i->second, -weight * m);
    }
  }

  std::optional<std::map<NodeId, Value>> solve() const {
    std::map<NodeId, Value> out;
    if (index_.empty()) return out;
    Eigen::SparseMatrix<double> left(size(), size());
    left.setFromTriplets(left_.begin(), left_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(left);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd pivots = solver.vectorD();
    if (pivots.minCoeff() <= 1e-12 * pivots.maxCoeff()) return std::nullopt;
    const Eigen::MatrixXd x = solver.solve(right_);
    for (const auto& [id, i] : index_) out[id] = x.middleRows<N>(N * i);
    return out;
  }

 private:
  Eigen::Index size() const { return N * static_cast<Eigen::Index>(index_.size()); }
  auto at(int i) { return right_.middleRows<N>(N * i); }
  void put(int i, int j, const Block& block) {
    for (int r = 0; r < N; ++r)
      for (int c = 0; c < N; ++c) left_.emplace_back(N * i + r, N * j + c, block(r, c));
  }

  Value anchor_value_;
  std::map<NodeId, int> index_;
  Triplets left_;
  Eigen::MatrixXd right_;
};

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

}  // namespace

std::optional<std::map<NodeId, Pose3>> chordalPoses(const std::map<NodeId, Pose3>& start, NodeId anchor,
                                                    const std::vector<RelativeEdge>& edges) {
  std::map<NodeId, Pose3> poses = start;
  // R_a R_ab = R_b, transposed so that the unknown is the right factor.
  LinearGraph<3> rotations(start, anchor, start.at(anchor).linear().transpose());
  for (const auto& edge : edges)
    rotations.add(edge.a, edge.b, edge.a_from_b.linear().transpose(), Eigen::Matrix3d::Zero(),
                  edge.rotation_weight);
  const auto turned = rotations.solve();
  if (!turned) return std::nullopt;
  for (const auto& [id, transposed] : *turned) poses[id].linear() = nearestRotation(transposed.transpose());
  // t_a + R_a t_ab = t_b.
  LinearGraph<1> places(start, anchor, start.at(anchor).translation().transpose());
  for (const auto& edge : edges)
    places.add(edge.a, edge.b, Eigen::Matrix<double, 1, 1>::Identity(),
               (poses[edge.a].linear() * edge.a_from_b.translation()).transpose(), edge.translation_weight);
  const auto moved = places.solve();
  if (!moved) return std::nullopt;
  for (const auto& [id, place] : *moved) poses[id].translation() = place.transpose();
  return poses;
}

}  // namespace roomgraph
