// SPDX-License-Identifier: BSD-3-Clause
// Drift since earlier key poses: against sums of steps by hand, over a gap, and with a loop closure.
#include "roomgraph/estimation/drift.h"

#include <gtest/gtest.h>

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
    const double moved = kShare * kStep_m2 * steps, turned = kShare * kStep_rad2 * steps * steps * steps;
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
  EXPECT_NEAR(of(0), moved + turned * 100, 1e-6);
  EXPECT_NEAR(drift_.turned(poses_, 0), turned, 1e-9);
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

TEST_F(DrivingDrift, OfNoKeyPoseIsNone) {
  EXPECT_EQ(drift_.variance(poses_, 3, {1, 2}), 0);
}

}  // namespace
}  // namespace roomgraph::test
