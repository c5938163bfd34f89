// SPDX-License-Identifier: BSD-3-Clause
// Trajectory errors and statistics against values worked out by hand.
#include "roomgraph/evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_poses.h"

namespace roomgraph {
namespace {

using test::Random;

Trajectory path(const std::vector<StampedPose>& poses) {
  Trajectory out;
  for (const auto& p : poses) out.add(p.t, p.pose);
  return out;
}

StampedPose flat(double t, double x, double y, double yaw = 0) {
  return {t, toPose3(Pose2{x, y, yaw})};
}

TEST(Statistics, HandComputed) {
  const auto s = summarize({3, 1, 4, 2});
  EXPECT_EQ(s.count, 4);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.squared_mean, 7.5);
  EXPECT_DOUBLE_EQ(s.squared_std, std::sqrt((6.5 * 6.5 + 3.5 * 3.5 + 1.5 * 1.5 + 8.5 * 8.5) / 4));
  EXPECT_DOUBLE_EQ(summarize({5, 1, 2}).median, 2);
  EXPECT_EQ(summarize({}).count, 0);
  std::vector<double> hundred;
  for (int i = 100; i > 0; --i) hundred.push_back(i);
  EXPECT_EQ(summarize(hundred).p95, 95);
  hundred.push_back(101);
  EXPECT_EQ(summarize(hundred).p95, 96) << "95 of 101 are less than 95 %";
  EXPECT_EQ(summarize({7}).p95, 7);
  EXPECT_EQ(summarize({3, 1, 4, 2}).p95, 4);
}

TEST(TrajectoryError, MovedTrajectoryHasNoError) {
  Random random(11);
  const Pose3 offset = random.pose(20);
  Trajectory truth, estimate;
  for (int i = 0; i < 30; ++i) {
    const Pose3 pose = random.pose(4);
    truth.add(i * 0.1, offset * pose);
    estimate.add(i * 0.1 + 0.004, pose);
  }
  const auto errors = evaluateTrajectory(truth, estimate);
  EXPECT_EQ(errors.pairs, 30);
  EXPECT_NEAR(errors.ate_m.max, 0, 1e-9);
  EXPECT_NEAR(errors.rpe_trans_m.max, 0, 1e-9);
  EXPECT_NEAR(errors.rpe_rot_deg.max, 0, 1e-5);
  EXPECT_EQ(errors.rpe_trans_m.count, 20);
  EXPECT_NEAR(errors.coverage, 1, 1e-9);
  EXPECT_EQ(errors.matched_share, 1);
  EXPECT_TRUE(errors.truth_from_estimate.isApprox(offset, 1e-9));
}

TEST(TrajectoryError, HandComputedAteWithAndWithoutAlignment) {
  // A unit square, one corner of which is estimated 0.4 m too far along x.
  const auto truth = path({flat(0, 0, 0), flat(1, 1, 0), flat(2, 1, 1), flat(3, 0, 1)});
  const auto estimate = path({flat(0, 0, 0), flat(1, 1.4, 0), flat(2, 1, 1), flat(3, 0, 1)});
  TrajectoryOptions raw;
  raw.align = false;
  const auto as_is = evaluateTrajectory(truth, estimate, raw);
  EXPECT_NEAR(as_is.ate_m.rmse, std::sqrt(0.16 / 4), 1e-12);
  EXPECT_NEAR(as_is.ate_m.mean, 0.1, 1e-12);
  EXPECT_NEAR(as_is.ate_m.median, 0, 1e-12);
  EXPECT_NEAR(as_is.ate_m.max, 0.4, 1e-12);
  // Aligned: no worse than the best of a fine search over the yaw about the means (.5, .5) and (.6, .5).
  const auto aligned = evaluateTrajectory(truth, estimate);
  double best = 1e9;
  for (int k = -20000; k <= 20000; ++k) {
    const Pose2 turn{0, 0, k * 1e-5};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d e = estimate.poses()[i].pose.translation().head<2>() - Eigen::Vector2d(0.6, 0.5);
      sum += (turn * e - (truth.poses()[i].pose.translation().head<2>() - Eigen::Vector2d(0.5, 0.5)))
                 .squaredNorm();
    }
    best = std::min(best, std::sqrt(sum / 4));
  }
  EXPECT_NEAR(aligned.ate_m.rmse, best, 1e-9);
  EXPECT_LT(aligned.ate_m.rmse, as_is.ate_m.rmse);
}

TEST(TrajectoryError, HandComputedRelativeErrors) {
  // One metre a second; the estimate is 10 % long and turns by .1 rad in the second step.
  const auto truth = path({flat(0, 0, 0), flat(1, 1, 0), flat(2, 2, 0)});
  const auto estimate = path({flat(0, 0, 0), flat(1, 1.1, 0), flat(2, 2.2, 0, 0.1)});
  const auto errors = evaluateTrajectory(truth, estimate);
  EXPECT_EQ(errors.rpe_trans_m.count, 2);
  EXPECT_NEAR(errors.rpe_trans_m.rmse, 0.1, 1e-12);
  const double degrees = 0.1 * 180 / M_PI;
  EXPECT_NEAR(errors.rpe_rot_deg.rmse, degrees / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(errors.rpe_rot_deg.mean, degrees / 2, 1e-9);
  TrajectoryOptions two;
  two.rpe_delta_s = 2;
  EXPECT_NEAR(evaluateTrajectory(truth, estimate, two).rpe_trans_m.rmse, 0.2, 1e-12);
  two.rpe_delta_s = 1;
  two.rpe_delta_frames = 2;
  EXPECT_EQ(evaluateTrajectory(truth, estimate, two).rpe_trans_m.count, 1);
  EXPECT_NEAR(evaluateTrajectory(truth, estimate, two).rpe_trans_m.rmse, 0.2, 1e-12);
}

TEST(TrajectoryError, RelativeErrorsDoNotReachOverHoles) {
  std::vector<StampedPose> poses;
  for (const double t : {0.0, 0.5, 1.0, 1.5, 7.0, 7.5, 8.0}) poses.push_back(flat(t, t, 0));
  const auto errors = evaluateTrajectory(path(poses), path(poses));
  EXPECT_EQ(errors.rpe_trans_m.count, 3);  // 0-1, .5-1.5, 7-8
  EXPECT_NEAR(errors.coverage, 2.5 / 8, 1e-12);
}

TEST(TrajectoryError, PairsByNearestStampOnce) {
  const auto truth = path({flat(0, 0, 0), flat(1, 1, 0), flat(2, 2, 0)});
  const auto estimate = path({flat(0.015, 0, 0), flat(0.985, 5, 0), flat(1.005, 1, 0), flat(2.03, 9, 0)});
  const auto pairs = associate(truth, estimate, {});
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].t, 0.015);
  EXPECT_EQ(pairs[1].t, 1.005);
  EXPECT_EQ(pairs[1].truth.translation().x(), 1);
  const auto errors = evaluateTrajectory(truth, estimate);
  EXPECT_EQ(errors.matched_share, 0.5);
  TrajectoryOptions wide;
  wide.max_difference_s = 0.05;
  EXPECT_EQ(associate(truth, estimate, wide).size(), 3u);
}

TEST(TrajectoryError, InterpolatedTruth) {
  const auto truth = path({flat(0, 0, 0), flat(1, 1, 0), flat(5, 5, 0)});
  const auto estimate = path({flat(-0.1, 0, 0), flat(0.25, 0.25, 0), flat(1, 1, 0), flat(3, 3, 0)});
  TrajectoryOptions options;
  options.interpolate_truth = true;
  const auto pairs = associate(truth, estimate, options);
  ASSERT_EQ(pairs.size(), 2u);  // before the start, and inside a hole of 4 s, there is no truth
  EXPECT_NEAR(pairs[0].truth.translation().x(), 0.25, 1e-12);
  EXPECT_EQ(pairs[1].truth.translation().x(), 1);
  options.max_gap_s = 4;
  EXPECT_EQ(associate(truth, estimate, options).size(), 3u);
}

TEST(TrajectoryError, NothingInCommon) {
  const auto a = path({flat(0, 0, 0), flat(1, 1, 0)}), b = path({flat(100, 0, 0)});
  for (const auto& errors :
       {evaluateTrajectory(a, b), evaluateTrajectory(a, {}), evaluateTrajectory({}, a)}) {
    EXPECT_EQ(errors.pairs, 0);
    EXPECT_EQ(errors.ate_m.count, 0);
    EXPECT_EQ(errors.coverage, 0);
    EXPECT_EQ(errors.matched_share, 0);
  }
}

TEST(TrajectoryError, AllWrongIsLarge) {
  const auto truth = path({flat(0, 0, 0), flat(1, 10, 0), flat(2, 10, 10), flat(3, 0, 10)});
  const auto stuck = path({flat(0, 0, 0), flat(1, 0, 0), flat(2, 0, 0), flat(3, 0, 0)});
  const auto errors = evaluateTrajectory(truth, stuck);
  EXPECT_NEAR(errors.ate_m.rmse, std::sqrt(50.0), 1e-9);  // every corner from the centre of the square
  EXPECT_NEAR(errors.rpe_trans_m.mean, 10, 1e-9);
}

}  // namespace
}  // namespace roomgraph
