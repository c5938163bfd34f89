// SPDX-License-Identifier: BSD-3-Clause
// PoseEstimator: sliding window with prior against the whole graph.
#include "roomgraph/pipeline/pose_estimator.h"

#include <gtest/gtest.h>

#include "circle_drive.h"
#include "drive.h"

namespace roomgraph::testing {
namespace {

// Wheels that drift, driven once round the circle; the whole graph is never due.
struct Estimation {
  explicit Estimation(int window_nodes) {
    stages->backend.window_nodes = window_nodes;
    stages->backend.optimize_every_nodes = 1000;
    stages->backend.urgent_closure_m = stages->backend.urgent_closure_rad = 1;
    estimator.measurements().planar = true;
  }
  // From one key pose to the next; a closure with the start comes with the last but two.
  void drive(bool close) {
    for (int t = 0; t < kNodes; ++t) {
      ASSERT_TRUE(estimator.advance(t));
      if (close && t == kNodes - 3) estimator.addClosures({closure(0, t)}, objects);
      estimator.update(objects);
    }
  }
  // What the least squares of everything at once say.
  Pose3 lastOfBatch() const {
    FactorGraph graph = buildGraph(estimator.poses(), motion, estimator.measurements(), {}, stages->backend);
    EXPECT_TRUE(graph.optimize(200).usable);
    return graph.pose(NodeId{kNodes - 1});
  }
  Pose3 last() const { return estimator.poses().nodes().back().world_from_robot; }

  MotionSource none{MotionNoise{}, true};
  Motion motion{drifting(1.03, 1.04, OdometryOptions().noise), none, none};
  std::unique_ptr<Stages> stages = stagesWith("[detection]\nenabled = false\n");
  PoseEstimator estimator{stages->backend, motion};
  ObjectMapper objects{*stages, estimator.poses()};
};

double distance(const Pose3& a, const Pose3& b) {
  return (a.translation() - b.translation()).norm();
}

// A closure no surer than the wheels comes early: every slide of the window must leave it the weight of one.
TEST(PoseEstimator, AClosureCountsOnceHoweverOftenTheWindowSlides) {
  for (const int nodes : {6, 10, 100}) {
    Estimation run(nodes);
    for (int t = 0; t < kNodes; ++t) {
      ASSERT_TRUE(run.estimator.advance(t));
      if (t == kNodes - 20) {
        RelativePose vague = closure(0, t);
        vague.covariance = 0.01 * Matrix6d::Identity();
        run.estimator.addClosures({vague}, run.objects);
      }
      run.estimator.update(run.objects);
    }
    EXPECT_LT(distance(run.last(), run.lastOfBatch()), 0.01) << "window of " << nodes;
  }
}

// The closure reaches back behind the window: only the prior knows how far the window may have drifted.
TEST(PoseEstimator, WindowWithItsPriorEndsWhereTheWholeGraphDoes) {
  for (const int nodes : {4, 8, 100}) {
    Estimation open(nodes), closed(nodes);
    open.drive(false);
    closed.drive(true);
    ASSERT_GT(distance(open.last(), truthAt(kNodes - 1)), 0.2) << "wheels without drift prove nothing";
    EXPECT_LT(distance(open.last(), open.lastOfBatch()), 1e-6);
    EXPECT_LT(distance(closed.last(), closed.lastOfBatch()), 0.01) << "window of " << nodes;
    EXPECT_LT(distance(closed.last(), truthAt(kNodes - 1)), 0.05) << "window of " << nodes;
  }
}

TEST(PoseEstimator, PosesThatLeftTheWindowStay) {
  Estimation run(5);
  run.drive(false);
  const std::vector<KeyPose> before = run.estimator.poses().nodes();
  run.estimator.addClosures({closure(2, kNodes - 2)}, run.objects);
  run.estimator.update(run.objects);
  const auto& after = run.estimator.poses().nodes();
  for (std::size_t i = 0; i + 5 < before.size(); ++i)
    EXPECT_TRUE(after[i].world_from_robot.matrix() == before[i].world_from_robot.matrix()) << i;
  EXPECT_GT(distance(after.back().world_from_robot, before.back().world_from_robot), 0.05);
}

// The prior is in the old frame then.
TEST(PoseEstimator, AMovedWorldDoesNotMoveBack) {
  Estimation run(5);
  run.drive(false);
  const Pose3 moved = poseFromYpr(3, -2, 0, 1, 0, 0), before = run.last();
  run.estimator.transform(moved);
  run.estimator.update(run.objects);
  EXPECT_LT(distance(run.last(), moved * before), 1e-6);
}

TEST(PoseEstimator, EverythingAtOnceIsTheWholeGraph) {
  Estimation run(5);
  run.drive(true);
  const Pose3 batch = run.lastOfBatch();
  EXPECT_TRUE(run.estimator.optimizeAll(run.objects));
  EXPECT_LT(distance(run.last(), batch), 1e-4);
}

}  // namespace
}  // namespace roomgraph::testing
