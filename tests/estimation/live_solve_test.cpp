// SPDX-License-Identifier: BSD-3-Clause
// PoseEstimator: the whole graph beside the run, and what happens meanwhile.
#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>

#include "circle_drive.h"
#include "roomgraph/estimation/pose_estimator.h"

namespace roomgraph::test {
namespace {

// Restores the number of threads.
class Threads {
 public:
  explicit Threads(int count) { cv::setNumThreads(count); }
  ~Threads() { cv::setNumThreads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_ = cv::getNumThreads();
};

// Wheels that drift, driven along the circle.
struct Drive {
  Drive() {
    options.window_nodes = 5;
    options.optimize_every_nodes = 12;
    options.urgent_closure_m = options.urgent_closure_rad = 0.1;
    estimator.setPlanar();
  }
  void on(int nodes) {
    for (const int end = t + nodes; t < end; ++t) {
      ASSERT_TRUE(estimator.advance(t));
      estimator.optimizeWindow();
    }
  }
  void begin() {
    estimator.beginLive([this](const KeyPoses& poses) {
      seen = poses.nodes().size();
      return ObjectsInGraph{};
    });
  }
  std::vector<Pose3> path() const {
    std::vector<Pose3> out;
    for (const KeyPose& node : estimator.poses().nodes()) out.push_back(node.world_from_robot);
    return out;
  }

  MotionSource none{MotionNoise{}, true};
  Motion motion{drifting(1.03, 1.04, kWheelNoise), none, none};
  BackendOptions options;
  PoseEstimator estimator{options, motion};
  int t = 0;
  std::size_t seen = 0;  // key poses for which factors of objects were asked
};

double distance(const Pose3& a, const Pose3& b) { return (a.translation() - b.translation()).norm(); }

TEST(LiveSolve, IsTakenOverThreeKeyPosesLaterWithAnyNumberOfThreads) {
  std::vector<std::vector<Pose3>> paths;
  for (const int threads : {1, 2}) {
    const Threads limit(threads);
    Drive drive;
    drive.on(20);
    drive.estimator.addClosures({closure(0, 19)});
    ASSERT_TRUE(drive.estimator.due());
    drive.begin();
    for (int later = 1; later <= 3; ++later) {
      EXPECT_FALSE(drive.estimator.takesOver()) << later;
      EXPECT_FALSE(drive.estimator.due()) << "nothing is begun twice";
      drive.on(1);
    }
    ASSERT_TRUE(drive.estimator.takesOver());
    ASSERT_TRUE(drive.estimator.takeOver());
    EXPECT_FALSE(drive.estimator.solving());
    EXPECT_EQ(drive.seen, 20u) << "what came meanwhile is not in it";
    EXPECT_LT(distance(drive.estimator.poses().at(19), truthAt(19)), 0.05);
    drive.on(4);
    paths.push_back(drive.path());
  }
  ASSERT_EQ(paths[0].size(), paths[1].size());
  for (std::size_t i = 0; i < paths[0].size(); ++i) EXPECT_EQ(paths[0][i].matrix(), paths[1][i].matrix()) << i;
}

TEST(LiveSolve, MovesWhatCameMeanwhileWithTheLastPoseOfItsGraph) {
  Drive drive;
  drive.on(20);
  drive.estimator.addClosures({closure(0, 12)});  // behind the window, which cannot follow it
  drive.begin();
  drive.on(3);
  const std::vector<Pose3> before = drive.path();
  const auto solution = drive.estimator.takeOver();
  ASSERT_TRUE(solution);
  const std::vector<Pose3> after = drive.path();
  ASSERT_GT(distance(before[19], after[19]), 0.02) << "a solution that changes nothing proves nothing";
  EXPECT_EQ(solution->later.since_t, 19);
  for (std::size_t i = 19; i < after.size(); ++i)
    EXPECT_LT((after[i].matrix() - (solution->later.new_from_old * before[i]).matrix()).norm(), 1e-9) << i;
}

// The same graph, solved while the robot waits.
TEST(LiveSolve, FindsWhatAnOptimisationFindsThatTheRunWaitsFor) {
  Drive drive, waiting;
  for (Drive* one : {&drive, &waiting}) {
    one->on(20);
    one->estimator.addClosures({closure(0, 19)});
    one->begin();
  }
  ASSERT_TRUE(waiting.estimator.takeOver());
  drive.on(3);
  ASSERT_TRUE(drive.estimator.takeOver());
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_EQ(drive.path()[i].matrix(), waiting.path()[i].matrix()) << i;
}

TEST(LiveSolve, IsVoidWhenPosesWereMovedMeanwhile) {
  Drive drive;
  drive.on(20);
  drive.begin();
  drive.on(3);
  drive.estimator.transform(poseFromYpr(3, -2, 0, 1, 0, 0));
  const std::vector<Pose3> moved = drive.path();
  ASSERT_TRUE(drive.estimator.takesOver());
  EXPECT_FALSE(drive.estimator.takeOver());
  EXPECT_FALSE(drive.estimator.solving());
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_EQ(drive.path()[i].matrix(), moved[i].matrix()) << i;
}

// Not in the graph that was being solved: that this did not bring it nearer says nothing.
TEST(LiveSolve, LeavesClosuresThatCameMeanwhileToTheNextOne) {
  Drive drive;
  drive.on(20);
  drive.begin();
  drive.on(2);
  drive.estimator.addClosures({closure(0, 21)});
  drive.on(1);
  ASSERT_TRUE(drive.estimator.takeOver());
  drive.on(2);
  ASSERT_FALSE(drive.estimator.due());
  drive.on(1);
  EXPECT_TRUE(drive.estimator.due()) << "after half the usual pause, counted from the beginning";
  drive.begin();
  ASSERT_TRUE(drive.estimator.takeOver());
  EXPECT_LT(distance(drive.estimator.poses().at(21), truthAt(21)), 0.05);
}

TEST(LiveSolve, TellsWhatItTookOnce) {
  Drive drive;
  drive.on(20);
  EXPECT_FALSE(drive.estimator.takeWork());
  drive.begin();
  EXPECT_FALSE(drive.estimator.takeWork());
  ASSERT_TRUE(drive.estimator.takeOver());
  const auto work = drive.estimator.takeWork();
  ASSERT_TRUE(work);
  EXPECT_GT(work->ms, 0);
  EXPECT_FALSE(drive.estimator.takeWork());
}

// An estimator that ends first waits for what it began.
TEST(LiveSolve, NeedNotBeTakenOver) {
  const Threads limit(2);
  Drive drive;
  drive.on(20);
  drive.begin();
}

}  // namespace
}  // namespace roomgraph::test
