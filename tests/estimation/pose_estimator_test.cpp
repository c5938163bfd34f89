// SPDX-License-Identifier: BSD-3-Clause
// PoseEstimator: sliding window with prior against the whole graph.
#include "roomgraph/estimation/pose_estimator.h"

#include <gtest/gtest.h>

#include "circle_drive.h"

namespace roomgraph::test {
namespace {

// Wheels that drift, driven once round the circle; the whole graph is never due.
struct Estimation {
  explicit Estimation(int window_nodes) {
    options.window_nodes = window_nodes;
    options.optimize_every_nodes = 1000;
    options.urgent_closure_m = options.urgent_closure_rad = 1;
    estimator.setPlanar();
  }
  void close(const RelativePose& closure) {
    closures.push_back(closure);
    EXPECT_TRUE(estimator.addClosures({closure}).empty()) << "wheels saw all of the way";
  }
  // From one key pose to the next; a closure with the start comes with the last but two.
  void drive(bool closed) {
    for (int t = 0; t < kNodes; ++t) {
      ASSERT_TRUE(estimator.advance(t));
      if (closed && t == kNodes - 3) close(closure(0, t));
      ASSERT_FALSE(estimator.due());
      estimator.optimizeWindow();
    }
  }
  // What the least squares of everything at once say.
  Pose3 lastOfBatch() const {
    FactorGraph graph = buildGraph(estimator.poses(), motion, {.closures = closures}, {}, options);
    EXPECT_TRUE(graph.optimize(200).usable);
    return graph.pose(NodeId{kNodes - 1});
  }
  Pose3 last() const { return estimator.poses().nodes().back().world_from_robot; }

  MotionSource none{MotionNoise{}, true};
  Motion motion{drifting(1.03, 1.04, kWheelNoise), none, none};
  BackendOptions options;
  PoseEstimator estimator{options, motion};
  GrowingList<RelativePose> closures;
};

// Without waiting for the turn of what is found.
bool optimizeNow(PoseEstimator& estimator) {
  estimator.beginLive([](const KeyPoses&) { return ObjectsInGraph{}; });
  return estimator.takeOver().has_value();
}

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
        run.close(vague);
      }
      run.estimator.optimizeWindow();
    }
    EXPECT_LT(distance(run.last(), run.lastOfBatch()), 0.01) << "window of " << nodes;
  }
}

// Both ends are in the window, then the older one leaves it: what the closure says is in the prior from then on.
TEST(PoseEstimator, AClosureWithinTheWindowCountsOnceWhenItsOlderEndHasLeft) {
  for (const int older : {1, 2, 3, 6}) {  // 2 leaves the window just as the closure comes
    Estimation run(10);
    run.options.closure_robust_width = 0;
    for (int t = 0; t < 20; ++t) {
      ASSERT_TRUE(run.estimator.advance(t));
      RelativePose doubtful = closure(older, t);
      doubtful.a_from_b.translation().x() += 0.2;
      doubtful.covariance = 0.01 * Matrix6d::Identity();
      if (t == 12) run.close(doubtful);
      run.estimator.optimizeWindow();
      if (t < 12) continue;
      FactorGraph graph = buildGraph(run.estimator.poses(), run.motion, {.closures = run.closures}, {}, run.options);
      ASSERT_TRUE(graph.optimize(200).usable);
      // What has left the window is held where it is.
      EXPECT_LT(distance(run.last(), graph.pose(run.estimator.poses().nodes().back().id)), older < 3 ? 0.02 : 0.001) << older << ", " << t;
    }
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

// Scans that are matched to local maps, whose poses stay variables of the window as long as they hold one of
// its key poses, and leave it with the last.
TEST(PoseEstimator, WindowWithLocalMapsEndsWhereTheWholeGraphDoes) {
  for (const int nodes : {4, 8, 100}) {
    Estimation open(nodes), closed(nodes);
    for (Estimation* run : {&open, &closed}) {
      run->motion.lidar = drifting(1.03, 1.06, {0.001, 0.04, 0.0005, 0.04, 0.02});
      run->options.local_map_nodes = 6;
    }
    open.drive(false);
    closed.drive(true);
    EXPECT_LT(distance(open.last(), open.lastOfBatch()), 0.002) << "window of " << nodes;
    ASSERT_GT(distance(open.last(), closed.last()), 0.08) << "a closure that changes nothing proves nothing";
    EXPECT_LT(distance(closed.last(), closed.lastOfBatch()), 0.01) << "window of " << nodes;
  }
}

// Images are lost while a local map would begin, and come back in the same segment: poses between are
// interpolated from then on, so that the local maps are others than those the window was built with.
TEST(PoseEstimator, ImagesThatComeBackChangeTheLocalMapsOfTheWindow) {
  for (const int lost : {3, 5, 8}) {
    Estimation run(5);
    run.options.local_map_nodes = 4;
    for (int t = 0; t < kNodes; ++t) {
      const bool seen = t < 10 || t >= 10 + lost;
      if (seen) run.motion.visual.add(t, truthAt(t), 0, 1e-6 * Matrix6d::Identity());
      ASSERT_TRUE(run.estimator.advance(t));
      ASSERT_NO_THROW(run.estimator.optimizeWindow()) << "lost for " << lost << " s, at " << t;
    }
    // Over what is longer than the window wheels alone carry it; afterwards images hold it again.
    if (lost < 5) {
      EXPECT_LT(distance(run.last(), run.lastOfBatch()), 0.05);
    }
    const Pose3 back = run.estimator.poses().nodes()[static_cast<std::size_t>(10 + lost)].world_from_robot;
    EXPECT_LT(distance(back.inverse() * run.last(), truthAt(10 + lost).inverse() * truthAt(kNodes - 1)),
              0.02);
  }
}

TEST(PoseEstimator, PosesThatLeftTheWindowStay) {
  Estimation run(5);
  run.drive(false);
  const std::vector<KeyPose> before = run.estimator.poses().nodes();
  run.close(closure(2, kNodes - 2));
  run.estimator.optimizeWindow();
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
  run.estimator.optimizeWindow();
  EXPECT_LT(distance(run.last(), moved * before), 1e-6);
}

TEST(PoseEstimator, EverythingAtOnceIsTheWholeGraph) {
  Estimation run(5);
  run.drive(true);
  const Pose3 batch = run.lastOfBatch();
  EXPECT_TRUE(run.estimator.optimizeAll({}));
  EXPECT_LT(distance(run.last(), batch), 1e-4);
}

// Pauses of 4 key poses, of 2 after a closure that disagrees.
TEST(PoseEstimator, AClosureIsUrgentUntilItIsMetOrOutvoted) {
  Estimation run(5);
  run.options.optimize_every_nodes = 4;
  run.options.urgent_closure_m = run.options.urgent_closure_rad = 0.1;
  int t = 0;
  const auto driveOn = [&](int nodes) {
    for (const int end = t + nodes; t < end; ++t) ASSERT_TRUE(run.estimator.advance(t));
  };
  driveOn(28);
  EXPECT_TRUE(optimizeNow(run.estimator));
  for (const int back : {3, 9, 15}) run.close(closure(back, t - 1));
  driveOn(2);
  EXPECT_TRUE(run.estimator.due()) << "the wheels had drifted";
  EXPECT_TRUE(optimizeNow(run.estimator));
  driveOn(2);
  EXPECT_FALSE(run.estimator.due()) << "the closures are met";
  RelativePose wrong = closure(6, t - 1);
  wrong.a_from_b.translation().x() += 1;
  run.close(wrong);
  for (int solves = 0; run.estimator.due(); ++solves) {
    ASSERT_LT(solves, 3) << "nothing brings it nearer";
    EXPECT_TRUE(optimizeNow(run.estimator));
    driveOn(2);
  }
  driveOn(1);
  EXPECT_FALSE(run.estimator.due());
  driveOn(1);
  EXPECT_TRUE(run.estimator.due()) << "as often as without it";
}

// Segments that links tie to each other: the drift over both gaps is theirs, not that of an unknown movement.
TEST(PoseEstimator, DriftOverGapsIsThatOfTheirLinks) {
  BackendOptions options;
  const MotionSource none{MotionNoise{}, true};
  Motion motion{none, MotionSource{MotionNoise{0.001, 0, 0.001, 0, 0, 1}, false}, none};
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  const auto at = [](double t) { return poseFromYpr(0.5 * t, 0, 0, 0, 0, 0); };
  for (int segment = 0; segment < 3; ++segment)
    for (int i = 0; i <= 20; ++i) {
      const double t = 6 * segment + 0.2 * i;
      motion.visual.add(t, at(t), segment, 1e-8 * Matrix6d::Identity());
      if (i % 5 == 0) {
        ASSERT_TRUE(estimator.advance(t)) << t;
      }
      if (i > 0 || segment == 0) continue;
      RelativePose link{t - 2, t, at(2)};
      link.covariance = 1e-4 * Matrix6d::Identity();
      link.link = true;
      estimator.addClosures({link});
    }
  EXPECT_LT(std::sqrt(estimator.drift().variance(estimator.poses(), 0, at(16).translation().head<2>())), 0.3);
  EXPECT_LT(distance(estimator.poses().at(16), at(16)), 1e-6) << "without a loss that lets a link go";
}

// So many key poses move in bodies, and closures between the same two are summed with weights of where these are.
TEST(PoseEstimator, SumsOfClosuresAreWeighedUntilTheySettle) {
  constexpr int kMany = 2100;
  const MotionSource none(MotionNoise{}, true);
  Motion motion{MotionSource(kWheelNoise, true), none, none};
  for (int k = 0; k <= 2 * kMany; ++k) motion.odometry.add(0.5 * k, poseFromYpr(0.1 * k, 0, 0, 0, 0, 0), 0);
  const BackendOptions options;
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  for (int t = 0; t < kMany; ++t) ASSERT_TRUE(estimator.advance(t));
  for (int i = 0; i < 5; ++i) {
    RelativePose seen{.t_a = 1210.0 + i, .t_b = 2090.0 + i, .a_from_b = poseFromYpr(0.2 * 880, i < 3 ? 0.5 : 0.44, 0, 0, 0, 0)};
    seen.covariance = 4e-4 * Matrix6d::Identity();
    estimator.addClosures({seen});
  }
  const auto optimised = [&] {
    const Eigen::Vector3d before = estimator.poses().nodes().back().world_from_robot.translation();
    EXPECT_TRUE(estimator.optimizeAll({}));
    return (estimator.poses().nodes().back().world_from_robot.translation() - before).norm();
  };
  EXPECT_GT(optimised(), 0.1) << "closures that say nothing prove nothing";
  EXPECT_LT(optimised(), 1e-3);
}

// Far off, a robust loss lets closures of images go; two that agree pull the path to them first.
TEST(PoseEstimator, TwoClosuresThatAgreePullAPathThatIsFarOff) {
  BackendOptions options;
  options.optimize_every_nodes = 1000;
  const MotionSource none{MotionNoise{}, true};
  const MotionNoise loose{0.001, 0.04, 0.05, 0.05, 0, 1};
  Motion motion{MotionSource{loose, true}, none, none};
  // Half a circle whose radius wheels take for half as long again.
  const auto arc = [](double t, double radius) { return poseFromYpr(radius * std::sin(t / radius), radius - radius * std::cos(t / radius), 0, t / radius, 0, 0); };
  const auto truth = [&](double t) { return arc(t, 10); };
  for (int t = 0; t <= 31; ++t) motion.odometry.add(t, arc(t, 15), 0, Matrix6d::Zero());
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  for (int t = 0; t <= 31; ++t) ASSERT_TRUE(estimator.advance(t));
  std::vector<RelativePose> closures;
  for (const double t : {29.0, 30.0}) {
    RelativePose closure{0, t, truth(t)};
    closure.covariance = 1e-4 * Matrix6d::Identity();
    closure.source = "tracking";
    closures.push_back(closure);
  }
  estimator.addClosures({closures[0]});
  EXPECT_TRUE(estimator.closures().empty()) << "alone it waits";
  estimator.addClosures({closures[1]});
  ASSERT_EQ(estimator.closures().size(), 2u);
  estimator.beginLive([](const KeyPoses&) { return ObjectsInGraph{}; });
  estimator.transform(Pose3::Identity());
  EXPECT_FALSE(estimator.takeOver()) << "void: the pull is still to come";
  for (int solve = 0; solve < 3; ++solve) EXPECT_TRUE(optimizeNow(estimator));
  for (const double t : {29.0, 30.0}) EXPECT_LT(distance(estimator.poses().at(t), truth(t)), 0.1) << t;
}

// The wheels stop for a while, and nothing saw the way, or they stand in a pause in which the robot may have been carried: a closure
// says where the robot went on.
class OverAGap : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(PoseEstimator, OverAGap, ::testing::Values(false, true));

TEST_P(OverAGap, AClosureMovesWhatCameAfterIt) {
  BackendOptions options;
  const MotionSource none{MotionNoise{}, true};
  Motion motion{MotionSource{kWheelNoise, true}, none, none};
  const bool paused = GetParam();
  for (int i = 0; i <= 10; ++i) motion.odometry.add(i, poseFromYpr(0.1 * i, 0, 0, 0, 0, 0), 0);
  for (int i = 50; i <= 60; ++i) motion.odometry.add(i, poseFromYpr(0.1 * (i - 50) + paused, 0, 0, 0, 0, 0), paused ? 0 : 1);
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  for (const double t : {0.0, 10.0, 50.0, 60.0}) ASSERT_TRUE(estimator.advance(t)) << t;
  const Pose3 before = estimator.poses().nodes()[3].world_from_robot;
  RelativePose closure;
  closure.t_a = 0;
  closure.t_b = 50;
  closure.a_from_b = poseFromYpr(4, 2, 0, 1, 0, 0);
  closure.covariance = 1e-4 * Matrix6d::Identity();
  const auto shifts = estimator.addClosures({closure});
  ASSERT_EQ(shifts.size(), 1u);
  EXPECT_EQ(shifts[0].since_t, 50);
  const auto& nodes = estimator.poses().nodes();
  EXPECT_LT(distance(nodes[2].world_from_robot, closure.a_from_b), 1e-9);
  EXPECT_LT(distance(nodes[3].world_from_robot, shifts[0].new_from_old * before), 1e-9);
  EXPECT_EQ(nodes[1].world_from_robot.translation().x(), 1) << "what lies before the gap stays";
}

// Wheels are lifted, and images were lost: those that begin anew see how the robot goes on, and nothing else does.
TEST(PoseEstimator, ASourceThatBeginsAnewCountsFromAKeyPoseOfItsOwn) {
  const BackendOptions options;
  Motion motion{MotionSource{kWheelNoise, true}, MotionSource{kScanNoise, false}, MotionSource{MotionNoise{}, true}};
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  const Matrix6d step = 1e-5 * Matrix6d::Identity();
  constexpr int kLost = 20, kAgain = 23, kLast = 60;
  constexpr double kStep_m = 0.05;
  for (int i = 0; i <= kLast; ++i) {
    const double t = 0.1 * i;
    motion.odometry.add(t, Pose3::Identity(), 0);
    if (i <= kLost) motion.visual.add(t, Pose3::Identity(), 0, step);
    if (i >= kAgain) motion.visual.add(t, poseFromYpr(7 + kStep_m * (i - kAgain), 0, 0, 0, 0, 0), 1, step);
    if (estimator.advance(t)) estimator.optimizeWindow();
  }
  EXPECT_NEAR(estimator.poses().at(0.1 * kAgain).translation().x(), 0, 0.01);
  EXPECT_NEAR(estimator.poses().at(0.1 * kLast).translation().x(), kStep_m * (kLast - kAgain), 0.05);
}

// Where scans saw all, images that are lost again and again cost nothing.
TEST(PoseEstimator, ScansNeedNoKeyPoseWhereImagesBeginAnew) {
  const BackendOptions options;
  Motion motion{MotionSource{kWheelNoise, true}, MotionSource{kScanNoise, false}, MotionSource{kScanNoise, true}};
  PoseEstimator estimator(options, motion);
  const Matrix6d step = 1e-5 * Matrix6d::Identity();
  for (int i = 0; i <= 40; ++i) {
    motion.lidar.add(0.1 * i, Pose3::Identity(), 0, step);
    motion.visual.add(0.1 * i, Pose3::Identity(), i / 3, step);
    estimator.advance(0.1 * i);
  }
  EXPECT_EQ(estimator.poses().nodes().size(), 1u);
}

// A camera held in the hand 1.3 m above the floor, pitched and rolled: the floor puts z up.
TEST(PoseEstimator, TheFloorLevelsAHandheldWorld) {
  const BackendOptions options;
  const MotionSource none{MotionNoise{}, false};
  const Motion motion{none, none, none};
  PoseEstimator estimator(options, motion);
  ASSERT_TRUE(estimator.advance(0));
  Pose3 level_from_camera = poseFromYpr(0, 0, 1.3, 0.4, 0, 0);
  level_from_camera.linear() = level_from_camera.linear() * poseFromYpr(0, 0, 0, 0, 0.3, -0.2).linear() *
                               bodyFromOptical();
  EXPECT_FALSE(estimator.levelled());
  estimator.addFloor(0, groundInCamera(level_from_camera), Pose3::Identity());
  EXPECT_FALSE(estimator.levelled()) << "what one frame saw";
  const Pose3 start = estimator.poses().at(0);
  const Pose3 moved = estimator.level(transformed(start, groundInCamera(level_from_camera))).new_from_old;
  EXPECT_TRUE(estimator.levelled());
  EXPECT_TRUE((moved * start).isApprox(estimator.poses().at(0), 1e-9));
  const Pose3 world_from_camera = estimator.poses().at(0);
  const Plane floor = groundInCamera(world_from_camera), seen = groundInCamera(level_from_camera);
  EXPECT_LT((floor.normal - seen.normal).norm(), 1e-9);
  EXPECT_NEAR(floor.offset, seen.offset, 1e-9);
  EXPECT_LT(world_from_camera.translation().head<2>().norm(), 1e-9) << "the start keeps its place";

  // That was a table; the floor is 0.7 m below it. Meanwhile world was moved into the frame of an earlier
  // map.
  const Pose3 map_from_world = poseFromYpr(3, -2, 0, 0.5, 0, 0);
  estimator.transform(map_from_world);
  estimator.level({Eigen::Vector3d::UnitZ(), 0.7});
  EXPECT_LT((estimator.poses().at(0).translation() - Eigen::Vector3d(3, -2, seen.offset + 0.7)).norm(), 1e-9);
  EXPECT_NEAR(estimator.poses().at(0).translation().z(), seen.offset + 0.7, 1e-9);
  EXPECT_TRUE(estimator.poses().at(0).linear().isApprox((map_from_world * world_from_camera).linear(), 1e-9));
}

TEST(PoseEstimator, ARobotOnTheFloorNeedsNoLevelling) {
  const BackendOptions options;
  const MotionSource none{MotionNoise{}, true};
  const Motion motion{none, none, none};
  PoseEstimator estimator(options, motion);
  estimator.setPlanar();
  ASSERT_TRUE(estimator.advance(0));
  estimator.addFloor(0, groundInCamera(poseFromYpr(0, 0, 1.3, 0, 0.3, -0.2)), Pose3::Identity());
  EXPECT_FALSE(estimator.levelled());
  EXPECT_TRUE(estimator.poses().at(0).isApprox(Pose3::Identity()));
}

}  // namespace
}  // namespace roomgraph::test
