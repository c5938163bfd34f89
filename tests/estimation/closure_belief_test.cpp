// SPDX-License-Identifier: BSD-3-Clause
// A closure that the poses do not show yet makes them no surer, and does not refuse those that say the same.
#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/estimation/pose_estimator.h"

namespace roomgraph::test {
namespace {

constexpr int kRound = 200;  // key poses, half a second each
constexpr double kRadius_m = 4.775;

Pose3 onCircle(int i) {
  const double a = 2 * M_PI * i / kRound;
  return toPose3(Pose2{kRadius_m * std::sin(a), kRadius_m * (1 - std::cos(a)), wrapAngle(a)});
}

double timeOf(int i) { return 1000 + 0.5 * i; }

/// Two rounds by wheels that are off by .8 m in the second one, as images of the first one say.
struct SecondRound {
  SecondRound() {
    for (int i = 0; i <= 2 * kRound; ++i) motion.odometry.add(timeOf(i), onCircle(i), 0);
    estimator.setPlanar();
    for (int i = 0; i <= kRound; ++i) estimator.advance(timeOf(i));
  }
  RelativePose seenAgain(int i) const {
    RelativePose out{timeOf(i - kRound), timeOf(i), onCircle(i - kRound).inverse() * off * onCircle(i)};
    out.covariance = 4e-4 * Matrix6d::Identity();
    out.source = "tracking";
    return out;
  }
  double sigma() const {
    const double t = estimator.poses().nodes().back().t;
    return std::sqrt(estimator.drift().variance(estimator.poses(), timeOf(0), estimator.poses().at(t).translation().head<2>()));
  }

  const Pose3 off = toPose3(Pose2{0.6, 0.5, 0.1});
  const MotionSource none{MotionNoise{}, true};
  Motion motion{MotionSource({0.01, 0.10, 0.01, 0.15, 0.10}, true), none, none};
  BackendOptions options;
  PoseEstimator estimator{options, motion};
};

TEST(ClosureBelief, ComesWithThePosesThatShowIt) {
  SecondRound run;
  const double before = run.sigma();
  for (const int i : {kRound, kRound + 5}) {
    for (int k = i - 4; k <= i; ++k)
      if (k > kRound) run.estimator.advance(timeOf(k));
    run.estimator.addClosures({run.seenAgain(i)});
  }
  ASSERT_EQ(run.estimator.closures().size(), 2u) << "the first waited for the second";
  EXPECT_GT(run.sigma(), 0.9 * before) << "the poses are where they were";
  for (int i = kRound + 6; i <= kRound + 8; ++i) {
    run.estimator.advance(timeOf(i));
    if (i != kRound + 7) run.estimator.addClosures({run.seenAgain(i)});
  }
  EXPECT_EQ(run.estimator.refusedClosures(), 0);
  EXPECT_EQ(run.estimator.closures().size(), 4u);
  for (int solve = 0; solve < 4; ++solve) {
    run.estimator.beginLive([](const KeyPoses&) { return ObjectsInGraph{}; });
    run.estimator.takeOver();
  }
  EXPECT_LT((run.estimator.poses().at(timeOf(kRound + 6)).translation() - (run.off * onCircle(kRound + 6)).translation()).norm(), 0.1);
  EXPECT_LT(run.sigma(), 0.6 * before) << "and now they show it";
}

}  // namespace
}  // namespace roomgraph::test
