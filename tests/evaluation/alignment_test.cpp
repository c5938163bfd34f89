// SPDX-License-Identifier: BSD-3-Clause
// Rigid alignment: exact, optimal under noise, planar and degenerate paths.
#include "roomgraph/evaluation/alignment.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "random_poses.h"

namespace roomgraph {
namespace {

using test::Random;

double cost(const Pose3& truth_from_estimate, const std::vector<PosePair>& pairs) {
  double sum = 0;
  for (const auto& pair : pairs)
    sum += (truth_from_estimate * pair.estimate.translation() - pair.truth.translation()).squaredNorm();
  return sum;
}

TEST(Alignment, FindsAnyRigidMovementExactly) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const Pose3 offset = random.pose(10);
    std::vector<PosePair> pairs;
    for (int i = 0; i < 10; ++i) {
      const Pose3 estimate = random.pose(5);
      pairs.push_back({double(i), offset * estimate, estimate});
    }
    EXPECT_TRUE(align(pairs).isApprox(offset, 1e-9));
    EXPECT_FALSE(isPlanar(pairs));
  }
}

TEST(Alignment, NoSmallMovementMakesTheNoisyFitBetter) {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    std::vector<PosePair> pairs;
    const Pose3 offset = random.pose(3);
    for (int i = 0; i < 8; ++i) {
      PosePair pair{double(i), random.pose(4), random.pose(4)};
      pair.truth.translation() = offset * pair.estimate.translation() + random.vector(0.5);
      pairs.push_back(pair);
    }
    const Pose3 best = alignSpatial(pairs);
    EXPECT_NEAR(best.linear().determinant(), 1, 1e-12);
    for (int k = 0; k < 6; ++k)
      for (const double step : {-1e-3, 1e-3}) {
        std::array<double, 6> by{};
        by[k] = step;
        const Pose3 nearby = best * poseFromYpr(by[0], by[1], by[2], by[3], by[4], by[5]);
        EXPECT_GT(cost(nearby, pairs), cost(best, pairs));
      }
  }
}

TEST(Alignment, MirroredPointsGetAProperRotation) {
  std::vector<PosePair> pairs;
  for (const auto& p : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 2, 0), Eigen::Vector3d(0, 0, 3),
                        Eigen::Vector3d(1, 1, 1)}) {
    PosePair pair;
    pair.estimate.translation() = p;
    pair.truth.translation() = Eigen::Vector3d(-p.x(), p.y(), p.z());
    pairs.push_back(pair);
  }
  EXPECT_NEAR(alignSpatial(pairs).linear().determinant(), 1, 1e-12);
}

TEST(Alignment, PlanarPathIsNeverFlippedOver) {
  // A path and its mirror image: in space half a turn fits well, but a robot does not drive upside down.
  std::vector<PosePair> pairs;
  for (const auto& p : {Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, -1), Eigen::Vector2d(0, 0)}) {
    PosePair pair;
    pair.truth.translation() = Eigen::Vector3d(p.x(), p.y(), 0.5);
    pair.estimate.translation() = Eigen::Vector3d(p.x() * 2, -p.y(), 0.2);
    pairs.push_back(pair);
  }
  ASSERT_TRUE(isPlanar(pairs));
  const Pose3 found = align(pairs);
  EXPECT_NEAR(found.linear()(2, 2), 1, 1e-12);
  EXPECT_NEAR(found.translation().z(), 0.3, 1e-12);
  // Sum of dots: 2*(2 - 1) = 2; sum of crosses (estimate x truth): 2*(2*1 + 1*1) = 6.
  EXPECT_NEAR(planarPart(found).yaw, std::atan2(6.0, 2.0), 1e-12);
}

TEST(Alignment, StraightLineTakesTheTurnAboutItselfFromTheOrientations) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    const Pose3 offset = random.pose(5);
    std::vector<PosePair> pairs;
    for (int i = 0; i < 6; ++i) {
      Pose3 estimate = Pose3::Identity();
      estimate.translation() = Eigen::Vector3d(0.3 * i, 0, 0);
      pairs.push_back({double(i), offset * estimate, estimate});
    }
    EXPECT_TRUE(alignSpatial(pairs).isApprox(offset, 1e-5));
  }
}

TEST(Alignment, StandingStillTakesTheRotationFromTheOrientations) {
  Random random(4);
  const Pose3 offset = random.pose(5), pose = random.pose(2);
  const std::vector<PosePair> pairs(3, PosePair{0, offset * pose, pose});
  EXPECT_TRUE(alignSpatial(pairs).isApprox(offset, 1e-9));
  const std::vector<PosePair> flat(2, PosePair{0, toPose3(Pose2{1, 2, 0.7}), toPose3(Pose2{0, 0, 0.2})});
  const Pose2 planar = alignPlanar(flat);
  EXPECT_NEAR(planar.yaw, 0.5, 1e-12);
  EXPECT_NEAR(planar.x, 1, 1e-12);
  EXPECT_NEAR(planar.y, 2, 1e-12);
}

// A robot that turns on the spot, with a millimetre of noise: as points 10 cm away its directions tell the yaw.
TEST(Alignment, DirectionsTellTheYawOfARobotThatHardlyMoves) {
  Random random(8);
  std::vector<PosePair> pairs;
  for (int i = 0; i < 200; ++i) {
    const auto noisy = [&](double sigma) { return Pose2{random.uniform(-sigma, sigma), random.uniform(-sigma, sigma), 0.1 * i}; };
    const Pose2 truth = noisy(0.001), estimate = noisy(0.003);
    pairs.push_back({double(i), toPose3(truth), toPose3(estimate)});
  }
  EXPECT_LT(std::abs(alignPlanar(pairs, 0.1).yaw), 0.01);
  EXPECT_GT(std::abs(alignPlanar(pairs).yaw), 0.02) << "positions alone do not";
}

TEST(Alignment, NoPairsGiveIdentity) {
  EXPECT_TRUE(align({}).isApprox(Pose3::Identity()));
  EXPECT_EQ(alignPlanar({}).yaw, 0);
}

}  // namespace
}  // namespace roomgraph
