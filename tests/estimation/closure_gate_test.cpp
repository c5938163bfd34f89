// SPDX-License-Identifier: BSD-3-Clause
// ClosureGate: what is near, what waits for a witness, what contradicts the drift, what is not of images.
#include "roomgraph/estimation/closure_gate.h"

#include <gtest/gtest.h>

namespace roomgraph::test {
namespace {

// A camera goes 40 m along x, a key pose each metre and second, and turns by twenty thousandths of a radian
// too far on the way: its estimate ends .4 m beside the truth, which a standard deviation of .3 m allows.
class Gate : public ::testing::Test {
 protected:
  Gate() {
    for (int i = 0; i <= 40; ++i) {
      Vector6d step;
      step << Vector6d::Constant(kStep_m2);
      step.tail<3>().setConstant(kStep_rad2);
      motion_.visual.add(i, estimated(i), 0, Matrix6d(step.asDiagonal()));
      poses_.add(i, estimated(i));
    }
    drift_.extend(poses_);
  }
  static Pose3 estimated(double t) { return poseFromYpr(t, 0.00025 * t * t, 0, 0.0005 * t, 0, 0); }
  static Pose3 truth(double t) { return poseFromYpr(t, 0, 0, 0, 0, 0); }
  static RelativePose closure(double a, double b, double off_m = 0) {
    RelativePose out{a, b, truth(a).inverse() * truth(b)};
    out.a_from_b.translation().y() += off_m;
    out.covariance = 1e-4 * Matrix6d::Identity();
    out.source = "tracking";
    return out;
  }
  std::size_t admitted(const std::vector<RelativePose>& offered) {
    return gate_.admit(offered, poses_, drift_).size();
  }

  static constexpr double kStep_m2 = 1e-3, kStep_rad2 = 1e-6;
  static constexpr MotionNoise kNone{1e-4, 0, 1e-4, 0, 0, 1};
  Motion motion_{MotionSource(kNone, true), MotionSource(kNone, false), MotionSource(kNone, true)};
  KeyPoses poses_{motion_};
  Drift drift_{motion_, true};
  ClosureGate gate_;
};

TEST_F(Gate, WhatHardlyMovesTheEstimateEnters) {
  EXPECT_EQ(admitted({closure(20, 40)}), 1u) << ".1 m";
}

TEST_F(Gate, WhatMovesItFarNeedsAWitnessOfOtherViews) {
  EXPECT_EQ(admitted({closure(0, 38)}), 0u);
  EXPECT_EQ(admitted({closure(0.2, 38.2)}), 0u) << "the same view";
  const auto both = gate_.admit({closure(2, 40)}, poses_, drift_);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].t_b, 38);
  EXPECT_EQ(both[1].t_b, 40);
  EXPECT_EQ(gate_.refused(), 0);
}

TEST_F(Gate, OfTwoThatDisagreeNeitherEnters) {
  EXPECT_EQ(admitted({closure(0, 38, -0.6)}), 0u);
  EXPECT_EQ(admitted({closure(2, 40)}), 0u);
}

TEST_F(Gate, WhatTheDriftCannotHaveDoneIsRefused) {
  EXPECT_EQ(admitted({closure(0, 39, 5), closure(2, 40, 5)}), 0u);
  EXPECT_EQ(gate_.refused(), 2);
  RelativePose turned = closure(0, 40);
  turned.a_from_b.linear() = poseFromYpr(0, 0, 0, M_PI, 0, 0).linear();
  EXPECT_EQ(admitted({turned}), 0u) << "a corridor looks alike both ways";
  EXPECT_EQ(gate_.refused(), 3);
}

// What is seen repeats itself: of two places that fit, the estimate tells which, or nothing does.
TEST_F(Gate, WhatFitsARivalAsWellIsRefusedWhateverFoundIt) {
  RelativePose alike = closure(20, 40);
  alike.rival_m = 5;
  EXPECT_EQ(admitted({alike}), 1u);
  alike.rival_m = 0.5;
  EXPECT_EQ(admitted({alike}), 0u);
  alike.source = "objects";
  EXPECT_EQ(admitted({alike}), 0u);
  EXPECT_EQ(gate_.refused(), 2);
}

TEST_F(Gate, LinksAndOtherSourcesPass) {
  RelativePose link = closure(0, 40, 5), lidar = link;
  link.link = true;
  lidar.source = "lidar";
  EXPECT_EQ(admitted({link, lidar}), 2u);
}

TEST_F(Gate, WhatWaitedEntersOnceTheEstimateAgrees) {
  EXPECT_EQ(admitted({closure(0, 40)}), 0u);
  for (int i = 0; i <= 40; ++i) poses_.set(NodeId{i}, truth(i));
  EXPECT_EQ(admitted({}), 1u);
  EXPECT_EQ(admitted({}), 0u) << "once";
}

}  // namespace
}  // namespace roomgraph::test
