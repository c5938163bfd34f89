// SPDX-License-Identifier: BSD-3-Clause
// PoseEstimator: the whole graph beside the run, and what happens meanwhile.
#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>
#include <thread>

#include "circle_drive.h"
#include "results_in_memory.h"
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
      asked_by = std::this_thread::get_id();
      return ObjectsInGraph{};
    });
  }
  std::vector<Pose3> path() const {
    std::vector<Pose3> out;
    for (const KeyPose& node : estimator.poses().nodes()) out.push_back(node.world_from_robot);
    return out;
  }

  std::size_t seen = 0;    // key poses for which factors of objects were asked
  std::thread::id asked_by;
  MotionSource none{MotionNoise{}, true};
  Motion motion{drifting(1.03, 1.04, kWheelNoise), none, none};
  BackendOptions options;
  PoseEstimator estimator{options, motion};
  int t = 0;
};

double distance(const Pose3& a, const Pose3& b) { return (a.translation() - b.translation()).norm(); }

TEST(LiveSolve, LargerGraphsHaveLonger) {
  EXPECT_EQ(PoseEstimator::lagOf(1), 3u);
  EXPECT_EQ(PoseEstimator::lagOf(500), 5u) << "a hundredth";
  EXPECT_EQ(PoseEstimator::lagOf(3000), 30u);
  EXPECT_EQ(PoseEstimator::lagOf(50000), 60u) << "that of 6000";
}

// How much movements between key poses have changed, those of [first, end).
double bent(const std::vector<Pose3>& before, const std::vector<Pose3>& now, std::size_t first, std::size_t end) {
  double most = 0;
  for (std::size_t i = first; i + 1 < end; ++i)
    most = std::max(most, distance(before[i].inverse() * before[i + 1], now[i].inverse() * now[i + 1]));
  return most;
}

// Closures bend drifting wheels: everywhere the first time; later in what came since, and between bodies.
TEST(LiveSolve, WhatWasInNoneBeforeBendsAndOlderOnesMoveInBodies) {
  const Threads one(1);
  Drive drive;
  drive.options.free_nodes = 2;
  const auto solved = [&drive] {
    const auto before = drive.path();
    drive.begin();
    EXPECT_TRUE(drive.estimator.takeOver());
    return std::pair(before, drive.path());
  };
  drive.on(24);
  drive.estimator.addClosures({closure(0, 22), closure(4, 23)});
  const auto [at_first, first] = solved();
  EXPECT_GT(bent(at_first, first, 0, 10), 1e-4);
  drive.on(12);
  drive.estimator.addClosures({closure(2, 34), closure(9, 35)});
  const auto [before, second] = solved();
  EXPECT_LT(bent(before, second, 0, 10), 1e-9);
  EXPECT_LT(bent(before, second, 10, 20), 1e-9);
  EXPECT_GT(bent(before, second, 9, 11), 1e-5);
  EXPECT_GT(bent(before, second, 24, 36), 1e-4);
}

TEST(LiveSolve, WhatOnlyAVoidSolutionHeldIsFreeInTheNext) {
  const Threads one(1);
  Drive drive;
  drive.options.free_nodes = 2;
  drive.on(24);
  drive.estimator.addClosures({closure(0, 22), closure(4, 23)});
  drive.begin();
  drive.estimator.transform(poseFromYpr(1, 0, 0, 0, 0, 0));
  EXPECT_FALSE(drive.estimator.takeOver()) << "the path was moved meanwhile";
  const auto before = drive.path();
  drive.begin();
  ASSERT_TRUE(drive.estimator.takeOver());
  EXPECT_GT(bent(before, drive.path(), 0, 10), 1e-4);
}

TEST(LiveSolve, AtTheEndOnlySearchesUseBodies) {
  Drive drive;
  drive.options.free_nodes = 5;
  drive.on(kNodes);
  using Effort = PoseEstimator::Effort;
  for (const auto& [effort, in_bodies] : {std::pair{Effort::kNear, false}, {Effort::kNearInBodies, true}, {Effort::kToTheEnd, false}}) {
    EXPECT_TRUE(drive.estimator.optimizeAll({}, effort));
    EXPECT_EQ(drive.estimator.graph().bodyOf(NodeId{1}) != NodeId{1}, in_bodies);
    EXPECT_EQ(drive.estimator.graph().bodyOf(NodeId{kNodes - 1}), NodeId{kNodes - 1});
  }
}

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
    EXPECT_EQ(drive.asked_by != std::this_thread::get_id(), threads > 1);
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
  EXPECT_TRUE(drive.estimator.due()) << "without another pause";
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_EQ(drive.path()[i].matrix(), moved[i].matrix()) << i;
}

// Not in the graph that was being solved: that this did not bring it nearer says nothing, but the poses are back where
// they were without it.
TEST(LiveSolve, IsFollowedAtOnceByOneThatKnowsOfClosuresThatCameMeanwhile) {
  Drive drive;
  drive.on(20);
  drive.begin();
  drive.on(2);
  drive.estimator.addClosures({closure(0, 21)});
  drive.on(1);
  ASSERT_TRUE(drive.estimator.takeOver());
  ASSERT_TRUE(drive.estimator.due());
  drive.begin();
  ASSERT_TRUE(drive.estimator.takeOver());
  EXPECT_LT(distance(drive.estimator.poses().at(21), truthAt(21)), 0.05);
  EXPECT_FALSE(drive.estimator.due());
}

// It came meanwhile, but agrees with what was found.
TEST(LiveSolve, MeetsClosuresThatCameMeanwhile) {
  Drive drive;
  drive.on(20);
  drive.estimator.addClosures({closure(0, 12)});
  drive.begin();
  drive.on(2);
  RelativePose met = closure(0, 12);
  met.t_b = 12.5;
  met.a_from_b = truthAt(0).inverse() * truthAt(12.5);
  drive.estimator.addClosures({met});
  drive.on(1);
  ASSERT_TRUE(drive.estimator.takeOver());
  EXPECT_FALSE(drive.estimator.due());
}

// The window that begins at the take-over may be shorter than what came meanwhile; what its last pose measured counts once.
TEST(LiveSolve, LeavesTheWindowWithEachMeasurementOnce) {
  for (const int nodes : {2, 3, 100}) {
    Drive drive;
    drive.options.window_nodes = nodes;
    drive.on(20);
    drive.begin();
    for (; drive.t < kNodes; ++drive.t) {
      ASSERT_TRUE(drive.estimator.advance(drive.t));
      if (drive.t == 22) {
        RelativePose vague = closure(0, drive.t);
        vague.covariance = 0.01 * Matrix6d::Identity();
        drive.estimator.addClosures({vague});
      }
      if (drive.estimator.takesOver()) {
        ASSERT_TRUE(drive.estimator.takeOver());
      }
      drive.estimator.optimizeWindow();
    }
    // Everything at once, with what the window began with held.
    const int held = std::max(19, 23 - nodes);
    FactorGraph graph;
    const auto& poses = drive.estimator.poses();
    for (const KeyPose& node : poses.nodes()) graph.addPose(node.id, node.world_from_robot, node.id.value <= held);
    for (auto i = static_cast<std::size_t>(held); i + 1 < poses.nodes().size(); ++i) {
      const auto step = drive.motion.odometry.between(poses.nodes()[i].t, poses.nodes()[i + 1].t, 1);
      graph.add(BetweenFactor{poses.nodes()[i].id, poses.nodes()[i + 1].id, step->a_from_b, step->covariance, 3});
      graph.add(PlanarFactor{poses.nodes()[i + 1].id, drive.options.planar_sigma_z_m, drive.options.planar_sigma_tilt_rad});
    }
    for (const RelativePose& seen : drive.estimator.closures())
      graph.add(*closureFactor(seen, poses, drive.options.closure_robust_width));
    ASSERT_TRUE(graph.optimize(200).usable);
    EXPECT_LT(distance(poses.nodes().back().world_from_robot, graph.pose(poses.nodes().back().id)), 0.01) << "window of " << nodes;
  }
}

// A run of ten minutes that is taken up again: what it takes to build the graph is far larger than its numbers.
TEST(LiveSolve, OfALongRunIsRecalled) {
  MotionSource wheels(kWheelNoise, true);
  for (int t = 0; t <= 800; ++t) wheels.add(t, poseFromYpr(0.5 * t, 0, 0, 0, 0, 0), 0, Matrix6d::Zero());
  const MotionSource none{MotionNoise{}, true};
  const Motion motion{wheels, none, none};
  const BackendOptions options;
  const auto endOf = [&](ResultsInMemory& store) {
    PoseEstimator estimator(options, motion);
    estimator.setPlanar();
    estimator.setResultStore(store);
    for (int t = 0; t <= 800; ++t) EXPECT_TRUE(estimator.advance(t));
    estimator.beginLive([](const KeyPoses& poses) {
      const std::vector<double> as_factors_of_scans_take(poses.nodes().size() * 4096);
      return ObjectsInGraph{.landmarks = std::vector<Landmark>(as_factors_of_scans_take.empty() ? 1 : 0), .factors = {}};
    });
    EXPECT_TRUE(estimator.takeOver());
    return estimator.poses().nodes().back().world_from_robot.matrix().eval();
  };
  ResultsInMemory first;
  const Eigen::Matrix4d end = endOf(first);
  ASSERT_EQ(first.kept, 1u);
  ResultsInMemory again = first.beginning(1);
  EXPECT_EQ(endOf(again), end);
  EXPECT_EQ(again.kept, 0u);
}

TEST(LiveSolve, TellsWhatItsThreadTookOnce) {
  const Threads limit(2);
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

TEST(LiveSolve, HasNoThreadToTellOfWithoutThreads) {
  const Threads limit(1);
  Drive drive;
  drive.on(20);
  drive.begin();
  ASSERT_TRUE(drive.estimator.takeOver());
  EXPECT_FALSE(drive.estimator.takeWork());
}

TEST(LiveSolve, PassesOnWhatGoesWrongInItsThread) {
  const Threads limit(2);
  Drive drive;
  drive.on(20);
  drive.estimator.beginLive([](const KeyPoses&) -> ObjectsInGraph { throw std::runtime_error("no factors"); });
  EXPECT_THROW(drive.estimator.takeOver(), std::runtime_error);
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
