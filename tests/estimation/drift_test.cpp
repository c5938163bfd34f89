// SPDX-License-Identifier: BSD-3-Clause
// Drift since earlier key poses: against sums of steps by hand, over a gap, and with a loop closure.
#include "roomgraph/estimation/drift.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

namespace roomgraph::test {
namespace {

constexpr double kStep_m2 = 1e-4, kStep_rad2 = 1e-6;  // of a movement by scans
constexpr double kShare = 0.25;

// Drives along x, a key pose each metre and second; scans are lost between the times `lost` and `found`.
class DrivingDrift : public ::testing::Test {
 protected:
  void drive(int poses, double lost = 1e9, double found = 1e9) {
    for (int scan = 0; scan <= 5 * (poses - 1); ++scan) {
      const double t = scan / 5.0;
      if (t > lost && t < found) continue;
      // A fifth of the step, as a key pose is made with each fifth scan.
      const Matrix6d step = Vector6d(Vector6d::Constant(kStep_m2 / 5)).asDiagonal();
      Matrix6d covariance = step;
      covariance(5, 5) = kStep_rad2 / 5;
      motion_.lidar.add(t, poseFromYpr(t, 0, 0, 0, 0, 0), t > lost, covariance);
    }
    for (int i = 0; i < poses; ++i) poses_.add(i, poseFromYpr(i, 0, 0, 0, 0, 0));
    drift_.extend(poses_);
  }

  double of(double t) const { return drift_.variance(poses_, t, poses_.at(t).translation().head<2>()); }

  static constexpr MotionNoise kNone{0, 0, 0, 0, 0, kShare, kShare};
  Motion motion_{MotionSource(kNone, true), MotionSource(kNone, false), MotionSource(kNone, true)};
  KeyPoses poses_{motion_};
  Drift drift_{motion_, true};
};

TEST_F(DrivingDrift, IsTheSumOfTheStepsAndOfTurnsTimesTheDistance) {
  drive(11);
  EXPECT_NEAR(of(10), 0, 1e-12) << "seen now";
  for (const double steps : {1.0, 4.0, 10.0}) {
    const double squares = steps * (steps + 1) * (2 * steps + 1) / 6;  // of the distances from where each step ends
    const double moved = kShare * kStep_m2 * steps, turned = kShare * kStep_rad2 * squares;
    EXPECT_NEAR(of(10 - steps), moved + turned, 1e-10) << steps << " m ago";
  }
  EXPECT_GT(drift_.variance(poses_, 8, {10, 20}), of(8)) << "a far place is moved more by turns";
}

TEST_F(DrivingDrift, GrowsToMetresWhenNothingMeasuresTheMovement) {
  drive(11, 4.1, 6.9);
  EXPECT_LT(std::sqrt(of(8)), 0.05) << "seen since";
  EXPECT_GT(std::sqrt(of(4)), 1) << "seen before nothing was known of three steps";
}

TEST_F(DrivingDrift, IsLeastAlongAClosureAndTheStepsFromIt) {
  drive(11);
  RelativePose closure{9, 2};
  closure.covariance = Matrix6d::Identity() * 1e-6;
  const double before = of(2), beside_before = of(3), recent_before = of(8);
  drift_.close(poses_, closure);
  EXPECT_LT(of(2), before);
  EXPECT_LT(of(3), beside_before) << "one step from the closure";
  EXPECT_GT(of(3), of(2));
  EXPECT_EQ(of(8), recent_before) << "the way itself is shorter";
  std::swap(closure.t_a, closure.t_b);
  const double closed = of(2);
  drift_.close(poses_, closure);
  EXPECT_EQ(of(2), closed) << "said twice, and the other way round";
}

// What no source saw is known by a link: drift is that of the steps and of the link.
TEST_F(DrivingDrift, ALinkStandsForTheGap) {
  for (int scan = 0; scan <= 50; ++scan) {
    const double t = scan / 5.0;
    if (t > 4.1 && t < 6.9) continue;
    Matrix6d step = Vector6d(Vector6d::Constant(kStep_m2 / 5)).asDiagonal();
    step(5, 5) = kStep_rad2 / 5;
    motion_.lidar.add(t, poseFromYpr(t, 0, 0, 0, 0, 0), t > 4.1, step);
  }
  for (int i = 0; i <= 10; ++i) {
    poses_.add(i, poseFromYpr(i, 0, 0, 0, 0, 0));
    drift_.extend(poses_);
    if (i != 7) continue;
    RelativePose link{4, 7};
    link.covariance = 0.01 * Matrix6d::Identity();
    link.covariance(5, 5) = 1e-8;
    EXPECT_GT(std::sqrt(of(4)), 1);
    drift_.link(poses_, link);
    EXPECT_NEAR(of(4), 0.01, 1e-5);
  }
  const double moved = 0.01 + kShare * kStep_m2 * (4 + 3), turned = 1e-8 + kShare * kStep_rad2 * (4 + 3);
  const double levers = 1e-8 * 49 + kShare * kStep_rad2 * (1 + 4 + 9 + 16 + 64 + 81 + 100);
  EXPECT_NEAR(of(0), moved + levers, 1e-7);
  EXPECT_NEAR(drift_.turned(poses_, 0), turned, 1e-9);
  RelativePose closure{10, 6};
  closure.covariance = 1e-10 * Matrix6d::Identity();
  drift_.close(poses_, closure);
  EXPECT_NEAR(of(5), 1e-10, 1e-8) << "nor is anything left of the gap's turns between two poses within";
}

// Around a block and back to its beginning, which turns on the far side move most: as 4000 drives with random errors scatter.
TEST(Drift, AroundALoopIsAsDrivesScatter) {
  constexpr double kRadius_m = 10, kSigma_m = 0.02, kSigma_rad = 0.01;
  constexpr int kSteps = 24, kDrives = 4000;
  constexpr MotionNoise kNone{0, 0, 0, 0, 0, 1, 1};
  Motion motion{MotionSource(kNone, true), MotionSource(kNone, false), MotionSource(kNone, true)};
  KeyPoses poses{motion};
  Drift drift{motion, true};
  const auto at = [](int i) {
    const double angle = 2 * M_PI * i / kSteps;
    return poseFromYpr(kRadius_m * std::sin(angle), kRadius_m * (1 - std::cos(angle)), 0, angle, 0, 0);
  };
  Matrix6d step = Matrix6d::Identity() * 1e-12;
  step.topLeftCorner<2, 2>() = kSigma_m * kSigma_m * Eigen::Matrix2d::Identity();
  step(5, 5) = kSigma_rad * kSigma_rad;
  for (int i = 0; i <= kSteps; ++i) motion.lidar.add(i, at(i), 0, step);
  for (int i = 0; i <= kSteps; ++i) poses.add(i, at(i));
  drift.extend(poses);

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Eigen::Matrix2d squares_m2 = Eigen::Matrix2d::Zero();
  for (int drive = 0; drive < kDrives; ++drive) {
    Pose3 now = Pose3::Identity();
    for (int i = 0; i < kSteps; ++i)
      now = now * at(i).inverse() * at(i + 1) *
            poseFromYpr(kSigma_m * normal(random), kSigma_m * normal(random), 0, kSigma_rad * normal(random), 0, 0);
    squares_m2 += now.translation().head<2>() * now.translation().head<2>().transpose();
  }
  const double scatter = std::sqrt(squares_m2.eigenvalues().real().maxCoeff() / kDrives), told = std::sqrt(drift.variance(poses, 0, {0, 0}));
  EXPECT_NEAR(told / scatter, 1, 0.05);
  EXPECT_GT(told, 3 * kSigma_m * std::sqrt(kSteps)) << "mostly of turns";
}

TEST_F(DrivingDrift, ContradictsWhatItCannotHaveDone) {
  drive(11);
  RelativePose closure{2, 10, poseFromYpr(8, 0, 0, 0, 0, 0)};
  closure.covariance = 1e-10 * Matrix6d::Identity();
  EXPECT_FALSE(drift_.contradicts(poses_, closure));
  const double sigma = std::sqrt(of(2));
  closure.a_from_b.translation().y() = 4.5 * sigma;
  EXPECT_FALSE(drift_.contradicts(poses_, closure));
  closure.a_from_b.translation().y() = 5.5 * sigma;
  EXPECT_TRUE(drift_.contradicts(poses_, closure));
  closure.a_from_b = poseFromYpr(8, 0, 0, 6 * std::sqrt(drift_.turned(poses_, 2)), 0, 0);
  EXPECT_TRUE(drift_.contradicts(poses_, closure));
}

TEST_F(DrivingDrift, TellsAClosureFromARivalThatIsFarther) {
  drive(11);
  RelativePose closure{2, 10, poseFromYpr(8, 0, 0, 0, 0, 0)};
  closure.covariance = 1e-10 * Matrix6d::Identity();
  EXPECT_TRUE(drift_.tellsFromRival(poses_, closure)) << "there is none";
  const double sigma = std::sqrt(drift_.variance(poses_, 2, {10, 0}));
  closure.rival_m = 4.1 * sigma;
  EXPECT_TRUE(drift_.tellsFromRival(poses_, closure));
  closure.rival_m = 3.9 * sigma;
  EXPECT_FALSE(drift_.tellsFromRival(poses_, closure));
  closure.a_from_b.translation().x() += sigma;
  closure.rival_m = 6.1 * sigma;
  EXPECT_TRUE(drift_.tellsFromRival(poses_, closure));
  closure.rival_m = 5.9 * sigma;
  EXPECT_FALSE(drift_.tellsFromRival(poses_, closure)) << "nearer to half the way between the two";
}

TEST_F(DrivingDrift, OfNoKeyPoseIsNone) {
  EXPECT_EQ(drift_.variance(poses_, 3, {1, 2}), 0);
}

}  // namespace
}  // namespace roomgraph::test
