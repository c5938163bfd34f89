// SPDX-License-Identifier: BSD-3-Clause
// Rotated covariances against those of rotated vectors.
#include "roomgraph/geometry/covariance.h"

#include <gtest/gtest.h>

#include "random_poses.h"

namespace roomgraph {
namespace {

using test::Random;

// A covariance is a sum of outer products d d': rotated is the sum over rotated d.
template <int N>
using Deviations = std::vector<Eigen::Matrix<double, N, 1>>;

template <int N>
Deviations<N> deviations(Random& random) {
  Deviations<N> out(2 * N);
  for (auto& d : out)
    for (int i = 0; i < N; ++i) d[i] = random.uniform(-1, 1);
  return out;
}

template <int N>
Eigen::Matrix<double, N, N> covarianceOf(const Deviations<N>& deviations) {
  Eigen::Matrix<double, N, N> sum = Eigen::Matrix<double, N, N>::Zero();
  for (const auto& d : deviations) sum += d * d.transpose();
  return sum;
}

TEST(Covariance, OfPlaceAndYawTurnsThePlaceOnly) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const auto before = deviations<4>(random);
    const Pose3 turn = random.pose(0);
    Deviations<4> after = before;
    for (auto& d : after) d.head<3>() = turn * Eigen::Vector3d(d.head<3>());
    EXPECT_TRUE(rotateCovariance(covarianceOf(before), turn.linear()).isApprox(covarianceOf(after), 1e-12));
  }
}

TEST(Covariance, OfMovementTurnsTranslationAndRotation) {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    const auto before = deviations<6>(random);
    const Pose3 turn = random.pose(0);
    Deviations<6> after = before;
    for (auto& d : after) {
      d.head<3>() = turn * Eigen::Vector3d(d.head<3>());
      d.tail<3>() = turn * Eigen::Vector3d(d.tail<3>());
    }
    EXPECT_TRUE(rotateCovariance(covarianceOf(before), turn.linear()).isApprox(covarianceOf(after), 1e-12));
  }
}

TEST(Covariance, OfPlanarPoseTurnsItsPlace) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    const auto before = deviations<3>(random);
    const double yaw = random.uniform(-3, 3);
    Deviations<3> after = before;
    for (auto& d : after) d.head<2>() = Pose2{0, 0, yaw} * Eigen::Vector2d(d.head<2>());
    EXPECT_TRUE(rotateCovariance(covarianceOf(before), yaw).isApprox(covarianceOf(after), 1e-12));
  }
}

TEST(Covariance, PlanarIn3dKeepsItsEntries) {
  Random random(4);
  const Eigen::Matrix3d planar = covarianceOf(deviations<3>(random));
  const Matrix6d out = planarCovariance(planar, 7);
  const int of_planar[6] = {0, 1, -1, -1, -1, 2};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const int r = of_planar[i], c = of_planar[j];
      EXPECT_EQ(out(i, j), r >= 0 && c >= 0 ? planar(r, c) : (i == j ? 7 : 0)) << i << " " << j;
    }
}

}  // namespace
}  // namespace roomgraph
