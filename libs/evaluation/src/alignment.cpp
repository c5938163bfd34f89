// SPDX-License-Identifier: BSD-3-Clause
// Umeyama alignment by SVD, with orientations for degenerate paths, and its planar form.
#include "roomgraph/evaluation/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

struct Moments {
  Eigen::Vector3d truth = Eigen::Vector3d::Zero(), estimate = Eigen::Vector3d::Zero();  // means
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // sum of (truth - mean)(estimate - mean)^T
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();  // sum of truth_R estimate_R^T
};

Moments momentsOf(const std::vector<PosePair>& pairs) {
  Moments out;
  const double n = static_cast<double>(pairs.size());
  for (const auto& pair : pairs) {
    out.truth += pair.truth.translation() / n;
    out.estimate += pair.estimate.translation() / n;
  }
  for (const auto& pair : pairs) {
    out.cross +=
        (pair.truth.translation() - out.truth) * (pair.estimate.translation() - out.estimate).transpose();
    out.turns += pair.truth.linear() * pair.estimate.linear().transpose();
  }
  return out;
}

Eigen::JacobiSVD<Eigen::Matrix3d> decompose(const Eigen::Matrix3d& matrix) {
  return Eigen::JacobiSVD<Eigen::Matrix3d>(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
}

// The rotation R that maximises trace(R^T matrix).
Eigen::Matrix3d nearestRotation(const Eigen::JacobiSVD<Eigen::Matrix3d>& svd) {
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs[2] = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

constexpr double kDegenerate = 1e-9;  // ratio of singular values, or m^2

}  // namespace

Pose3 alignSpatial(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return Pose3::Identity();
  const Moments moments = momentsOf(pairs);
  auto svd = decompose(moments.cross);
  const Eigen::Vector3d values = svd.singularValues();
  if (values[0] < kDegenerate) {
    svd = decompose(moments.turns);
  } else if (values[1] < kDegenerate * values[0]) {
    // Positions on a line do not determine the rotation about it: the orientations do, with a weight too small to
    // change the rest.
    const double weight = 1e-8 * values[0] / static_cast<double>(pairs.size());
    svd = decompose(moments.cross + weight * moments.turns);
  }
  Pose3 out = Pose3::Identity();
  out.linear() = nearestRotation(svd);
  out.translation() = moments.truth - out.linear() * moments.estimate;
  return out;
}

Pose2 alignPlanar(const std::vector<PosePair>& pairs, double lever_m) {
  if (pairs.empty()) return {};
  const Moments moments = momentsOf(pairs);
  const auto turnOf = [](const Eigen::Matrix3d& m) {
    return Eigen::Vector2d(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1));
  };
  Eigen::Vector2d turn = turnOf(moments.cross) + lever_m * lever_m * turnOf(moments.turns);
  if (turn.norm() < kDegenerate) turn = turnOf(moments.turns);
  Pose2 out{0, 0, std::atan2(turn.y(), turn.x())};
  const Eigen::Vector2d shift = moments.truth.head<2>() - out * Eigen::Vector2d(moments.estimate.head<2>());
  out.x = shift.x();
  out.y = shift.y();
  return out;
}

bool isPlanar(const std::vector<PosePair>& pairs) {
  constexpr double kTolerance = 1e-6;
  return std::all_of(pairs.begin(), pairs.end(), [&](const PosePair& pair) {
    const auto flat = [&](const Pose3& pose, const Pose3& first) {
      return std::abs(pose.translation().z() - first.translation().z()) < kTolerance &&
             pose.linear().col(2).head<2>().norm() < kTolerance && pose.linear()(2, 2) > 0;
    };
    return flat(pair.truth, pairs.front().truth) && flat(pair.estimate, pairs.front().estimate);
  });
}

Pose3 align(const std::vector<PosePair>& pairs) {
  if (pairs.empty() || !isPlanar(pairs)) return alignSpatial(pairs);
  Pose3 out = toPose3(alignPlanar(pairs));
  out.translation().z() = pairs.front().truth.translation().z() - pairs.front().estimate.translation().z();
  return out;
}

}  // namespace roomgraph
