// SPDX-License-Identifier: BSD-3-Clause
// Least-squares fit of the B-spline of a path.
#include "planar_path.h"

#include <Eigen/SparseCholesky>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kLeastSpacing_s = 0.15, kSpacingPerPose = 1.5;
constexpr double kStiffness = 1e-4;  // weight of second differences, for pieces without poses

}  // namespace

bool PlanarPath::add(double t, const Pose2& pose) {
  if (!times_.empty() && t <= times_.back()) return false;
  const double before = times_.empty() ? 0 : values_.back()[2];
  times_.push_back(t);
  values_.push_back({pose.x, pose.y, before + wrapAngle(pose.yaw - before)});
  return true;
}

void PlanarPath::smooth() {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < size(); ++i) intervals.push_back(times_[i] - times_[i - 1]);
  spacing_s_ = std::max(kLeastSpacing_s, kSpacingPerPose * median(intervals));
  const auto pieces =
      static_cast<std::size_t>(std::ceil((times_.back() - times_.front()) / spacing_s_ + 1e-9));
  controls_.assign(std::max<std::size_t>(1, pieces) + 3, {});
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(controls_.size()), 3);
  const auto addRow = [&](std::size_t first, const auto& weights, const PlanarValues<double>& value) {
    for (std::size_t a = 0; a < weights.size(); ++a) {
      const auto row = static_cast<int>(first + a);
      for (std::size_t b = 0; b < weights.size(); ++b)
        entries.emplace_back(row, static_cast<int>(first + b), weights[a] * weights[b]);
      for (std::size_t k = 0; k < 3; ++k) right(row, static_cast<int>(k)) += weights[a] * value[k];
    }
  };
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t piece = pieceOf(times_[i]);
    addRow(piece, basis((times_[i] - times_.front()) / spacing_s_ - static_cast<double>(piece)), values_[i]);
  }
  for (std::size_t i = 0; i + 2 < controls_.size(); ++i)
    addRow(i, std::array<double, 3>{kStiffness, -2 * kStiffness, kStiffness}, {0, 0, 0});
  const auto count = static_cast<Eigen::Index>(controls_.size());
  Eigen::SparseMatrix<double> left(count, count);
  left.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixX3d solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(left).solve(right);
  for (std::size_t i = 0; i < controls_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) controls_[i][k] = solution(static_cast<int>(i), static_cast<int>(k));
}

}  // namespace roomgraph
