// SPDX-License-Identifier: BSD-3-Clause
// Graph of a run: motion sources, closures, windows, ground factors and landmarks.
#include "roomgraph/estimation/graph_builder.h"

#include <gtest/gtest.h>

#include "circle_drive.h"

namespace roomgraph::test {
namespace {

struct Scenario {
  Motion motion;
  Measurements measurements;
  ObjectsInGraph objects;
  BackendOptions options;

  // Key poses as dead reckoning of the best source would have them.
  KeyPoses start() const {
    KeyPoses poses(motion);
    for (int i = 0; i < kNodes; ++i) poses.add(i, motion.movement(0, i, 0).value_or(Pose3::Identity()));
    return poses;
  }
  double meanError() const {
    const KeyPoses poses = start();
    FactorGraph graph = buildGraph(poses, motion, measurements, objects, options);
    EXPECT_TRUE(graph.optimize().usable);
    double sum = 0;
    for (int i = 0; i < kNodes; ++i)
      sum += (graph.pose(NodeId{i}).translation() - truthAt(i).translation()).norm();
    return sum / kNodes;
  }
};

Scenario wheelsOnly() {
  const MotionSource none(MotionNoise{}, true);
  return {{drifting(1.05, 1.08, kWheelNoise), none, none}, {}, {}, {}};
}

TEST(GraphBuilder, ScansCorrectTheWheels) {
  Scenario wheels = wheelsOnly(), both = wheels;
  both.motion.lidar = drifting(1, 1.002, kScanNoise);
  const double alone = wheels.meanError();
  EXPECT_GT(alone, 0.15) << "wheels without drift prove nothing";
  EXPECT_LT(both.meanError(), 0.03);
}

TEST(GraphBuilder, ClosureBetweenAnyTwoTimesPullsTheLoopShut) {
  Scenario open = wheelsOnly(), closed = open;
  // Times off the key poses: the sources of motion carry the closure there.
  closed.measurements.closures = {closure(0.3, 38.6), closure(10.4, 38.6), closure(0.3, 20.5)};
  EXPECT_LT(closed.meanError(), 0.5 * open.meanError());
}

TEST(GraphBuilder, WrongClosureIsShruggedOff) {
  Scenario scenario = wheelsOnly();
  scenario.motion.lidar = drifting(1, 1.002, kScanNoise);
  RelativePose wrong = closure(2, 20);
  wrong.a_from_b = Pose3::Identity();
  scenario.measurements.closures = {wrong};
  EXPECT_LT(scenario.meanError(), 0.06);
  scenario.options.closure_robust_width = 0;
  EXPECT_GT(scenario.meanError(), 0.2) << "a harmless closure proves nothing";
}

TEST(GraphBuilder, WithoutAnySourceThePosesStayTogether) {
  const MotionSource none(MotionNoise{}, true);
  const Scenario scenario{{none, none, none}, {}, {}, {}};
  FactorGraph graph =
      buildGraph(scenario.start(), scenario.motion, scenario.measurements, {}, scenario.options);
  ASSERT_TRUE(graph.optimize().usable);
  for (int i = 0; i < kNodes; ++i) EXPECT_LT(graph.pose(NodeId{i}).translation().norm(), 1e-6);
}

TEST(GraphBuilder, CountsOfPosesAndFactors) {
  Scenario scenario = wheelsOnly();
  scenario.measurements.closures = {closure(0, 30), closure(2, 5)};
  const KeyPoses poses = scenario.start();
  const FactorGraph whole =
      buildGraph(poses, scenario.motion, scenario.measurements, scenario.objects, scenario.options);
  EXPECT_EQ(whole.poses(), 40u);
  EXPECT_EQ(whole.factors(), 39u + 39u + 2u);  // movements, planar, closures
  const auto window = [&](std::size_t first) {
    return buildWindow(poses, scenario.motion, scenario.measurements, scenario.options, first, std::nullopt)
        .graph;
  };
  EXPECT_EQ(window(34).poses(), 6u);
  EXPECT_EQ(window(34).factors(), 5u + 5u);  // closures are all older
  EXPECT_EQ(window(28).poses(), 12u + 1u);   // and the pose that a closure reaches back to
  EXPECT_EQ(window(28).factors(), 11u + 11u + 1u);
}

TEST(GraphBuilder, FirstPoseOfAWindowIsHeld) {
  const Scenario scenario = wheelsOnly();
  const KeyPoses poses = scenario.start();
  FactorGraph graph = buildWindow(poses, scenario.motion, {}, scenario.options, 30, std::nullopt).graph;
  ASSERT_TRUE(graph.optimize().usable);
  EXPECT_TRUE(graph.pose(NodeId{30}).isApprox(poses.nodes()[30].world_from_robot, 1e-9));
}

TEST(GraphBuilder, OnlyLandmarksThatWereSeenAreInTheGraph) {
  Scenario scenario = wheelsOnly();
  const Eigen::Vector3d place(1, 1, 0);
  for (int id : {0, 1}) {
    Landmark landmark;
    landmark.id = LandmarkId{id};
    landmark.position = place + Eigen::Vector3d(0.4 * id, 0, 0);
    scenario.objects.landmarks.push_back(landmark);
  }
  const LandmarkId view{100};
  scenario.objects.factors.yaws[LandmarkId{1}] = 0;
  scenario.objects.factors.views[view] = {place, 0, {}};
  LandmarkViewFactor shared{view, LandmarkId{1}};
  shared.covariance = 1e-4 * Eigen::Matrix4d::Identity();
  scenario.objects.factors.shared_errors = {shared};
  for (int i : {3, 7}) {
    LandmarkFactor sighting{NodeId{i}, view};
    sighting.position_in_robot = truthAt(i).inverse() * place;
    sighting.covariance = 1e-4 * Eigen::Matrix4d::Identity();
    scenario.objects.factors.sightings.push_back(sighting);
  }
  const KeyPoses poses = scenario.start();
  FactorGraph graph =
      buildGraph(poses, scenario.motion, scenario.measurements, scenario.objects, scenario.options);
  EXPECT_EQ(graph.landmarks(), 2u) << "the landmark and its view";
  EXPECT_TRUE(graph.hasLandmark(LandmarkId{1}));
  ASSERT_TRUE(graph.optimize().usable);
  EXPECT_LT((graph.landmark(LandmarkId{1}).position - place).norm(), 0.1);
}

// Local maps, views and points are nowhere else: built again after a solution, the graph is still at its
// optimum.
TEST(GraphBuilder, BuiltAgainAGraphBeginsWhereItsFormerSolutionEnded) {
  Scenario scenario = wheelsOnly();
  scenario.motion.lidar = drifting(1, 1.002, kScanNoise);
  scenario.measurements.closures = {closure(0, 30)};
  const Eigen::Vector3d place(1, 1, 0);
  Landmark& landmark = scenario.objects.landmarks.emplace_back();
  landmark.id = LandmarkId{1};
  landmark.position = place;
  const LandmarkId view{100};
  ObjectFactors& factors = scenario.objects.factors;
  factors.yaws[LandmarkId{1}] = 0;
  factors.views[view] = {place, 0, {}};
  LandmarkViewFactor shared{view, LandmarkId{1}};
  shared.covariance = 1e-4 * Eigen::Matrix4d::Identity();
  factors.shared_errors = {shared};
  LandmarkFactor sighting{NodeId{3}, view};
  sighting.position_in_robot = truthAt(3).inverse() * place + Eigen::Vector3d(0.2, 0, 0);
  sighting.covariance = 1e-4 * Eigen::Matrix4d::Identity();
  factors.sightings = {sighting};
  KeyPoses poses = scenario.start();
  const auto build = [&](const FactorGraph* former) {
    return buildGraph(poses, scenario.motion, scenario.measurements, scenario.objects, scenario.options,
                      former);
  };
  FactorGraph first = build(nullptr);
  ASSERT_TRUE(first.optimize({.max_iterations = 200, .function_tolerance = 1e-12}).usable);
  for (int i = 0; i < kNodes; ++i) poses.set(NodeId{i}, first.pose(NodeId{i}));
  landmark.position = first.landmark(LandmarkId{1}).position;
  EXPECT_NEAR(build(&first).chiSquared(), first.chiSquared(), 1e-6);
  EXPECT_GT(build(nullptr).chiSquared(), first.chiSquared() + 1) << "nothing to go on from proves nothing";
}

// Wheels that turn too far, put right by closures: bodies of ten are bent where they join, single poses within.
TEST(GraphBuilder, OldKeyPosesMoveTogether) {
  Scenario scenario = wheelsOnly();
  scenario.motion.lidar = drifting(1, 1.01, kScanNoise);
  scenario.options.closure_robust_width = 0;
  for (int i = 0; i < kNodes; i += 4) scenario.measurements.closures.push_back(closure(i, kNodes - 0.5));
  const KeyPoses poses = scenario.start();
  const auto solved = [&](std::size_t free) {
    FactorGraph graph = buildGraph(poses, scenario.motion, scenario.measurements, {}, scenario.options, nullptr, free);
    EXPECT_TRUE(graph.optimize(100).usable);
    return graph;
  };
  const FactorGraph all = solved(kAllFree), few = solved(5);
  EXPECT_EQ(all.poses() - few.poses(), 31u) << "of 35, 0, 10, 20 and 30 lead";
  double moved = 0, apart = 0;
  for (int i = 0; i < kNodes; ++i) {
    const int leader = i - i % 10;
    EXPECT_EQ(few.bodyOf(NodeId{i}), NodeId{i < 35 ? leader : i}) << i;
    const auto between = [](const Pose3& a, const Pose3& b) { return a.inverse() * b; };
    const Pose3& before = poses.nodes()[static_cast<std::size_t>(i)].world_from_robot;
    if (i < 35) {
      const Pose3 as_before = between(poses.nodes()[static_cast<std::size_t>(leader)].world_from_robot, before);
      EXPECT_TRUE(between(few.pose(NodeId{leader}), few.pose(NodeId{i})).isApprox(as_before, 1e-9)) << i;
    }
    moved = std::max(moved, between(before, few.pose(NodeId{i})).translation().norm());
    apart = std::max(apart, between(all.pose(NodeId{i}), few.pose(NodeId{i})).translation().norm());
  }
  EXPECT_GT(moved, 0.02) << "a path that was right proves nothing";
  EXPECT_LT(apart, 0.1 * moved);
}

// A straight drive, a key pose each second, measured by scans.
FactorGraph longDrive(int key_poses, std::size_t free, const Measurements& measurements = {}) {
  const MotionSource none(MotionNoise{}, true);
  Scenario scenario{{none, none, MotionSource(kScanNoise, true)}, {}, {}, {}};
  for (int k = 0; k <= 10 * key_poses; ++k)
    scenario.motion.lidar.add(0.1 * k, poseFromYpr(0.02 * k, 0, 0, 0, 0, 0), 0, Matrix6d::Identity() * 1e-6);
  KeyPoses poses(scenario.motion);
  for (int i = 0; i < key_poses; ++i) poses.add(i, poseFromYpr(0.2 * i, 0, 0, 0, 0, 0));
  return buildGraph(poses, scenario.motion, measurements, {}, scenario.options, nullptr, free);
}

TEST(GraphBuilder, BodiesAreTwiceAsLongWhereTwiceAsManyKeyPosesCame) {
  constexpr int kAll = 4500;
  const FactorGraph graph = longDrive(kAll, 50);
  std::size_t leaders = 0, maps = 0;
  for (int i = 0; i < kAll; ++i) {
    const int age = kAll - i, length = age <= 50 ? 1 : age <= 1000 ? 10 : age <= 2000 ? 20 : age <= 4000 ? 40 : 80;
    EXPECT_EQ(graph.bodyOf(NodeId{i}) == NodeId{i}, i % length == 0) << i;
    leaders += i % length == 0;
    maps += i % 10 == 0 && length <= 10;
  }
  EXPECT_EQ(graph.poses(), leaders + maps) << "local maps have a pose of their own where bodies are no longer";
}

TEST(GraphBuilder, LongBodiesAreHeldToTheFloorByTenOfTheirKeyPoses) {
  constexpr int kAll = 4500;
  std::size_t expected = 0;
  for (int i = 1; i < kAll; ++i) {
    const int age = kAll - i, length = age <= 50 ? 1 : age <= 1000 ? 10 : age <= 2000 ? 20 : age <= 4000 ? 40 : 80;
    expected += i % std::max(1, length / 10) == 0;
  }
  for (int i = 0; i < kAll; i += 10) expected += kAll - i <= 1000;  // local maps with a pose of their own
  const FactorGraph on_floor = longDrive(kAll, 50), in_hand = longDrive(kAll, 50, {{}, {}, false});
  EXPECT_EQ(on_floor.factors() - in_hand.factors(), expected);
}

TEST(GraphBuilder, ClosuresBetweenTwoBodiesBecomeOneFactor) {
  constexpr int kAll = 2200;
  Measurements measurements;
  const auto close = [&](int a, int b) {
    RelativePose closure{.t_a = static_cast<double>(a), .t_b = static_cast<double>(b), .a_from_b = poseFromYpr(0.2 * (b - a), 0, 0, 0, 0, 0)};
    closure.covariance = Matrix6d::Identity() * 1e-4;
    measurements.closures.push_back(closure);
  };
  const std::size_t before = longDrive(kAll, 50).factors();
  for (int i = 0; i < 7; ++i) close(i, 1320 + i);
  EXPECT_EQ(longDrive(kAll, 50, measurements).factors(), before + 1);
  close(100, 1320);
  EXPECT_EQ(longDrive(kAll, 50, measurements).factors(), before + 2) << "of another body";
  close(100, kAll - 2);
  close(101, kAll - 2);
  EXPECT_EQ(longDrive(kAll, 50, measurements).factors(), before + 4) << "of a pose by itself each stays";
}

TEST(GraphBuilder, OfVeryManyKeyPosesBodiesMoveInTheEndAsWell) {
  const FactorGraph many = longDrive(2001, kAllFree), fewer = longDrive(2000, kAllFree);
  for (int i = 0; i < 2001; ++i) {
    const int age = 2001 - i, length = age <= 1000 ? 10 : age <= 2000 ? 20 : 40;
    EXPECT_EQ(many.bodyOf(NodeId{i}) == NodeId{i}, i % length == 0) << i;
  }
  EXPECT_LT(many.poses(), 400u);
  EXPECT_EQ(fewer.poses(), 2000u + 200);
}

// What bodies hold is as it was measured, and a closure bends them where they join.
TEST(GraphBuilder, LongBodiesWithTheirLocalMapsBendWhereTheyJoin) {
  constexpr int kAll = 2200;
  FactorGraph graph = longDrive(kAll, 50);
  graph.add(BetweenFactor{NodeId{0}, NodeId{kAll - 1}, poseFromYpr(0.2 * (kAll - 1), 3, 0, 0, 0, 0), Matrix6d::Identity() * 1e-6, 0});
  ASSERT_TRUE(graph.optimize(100).usable);
  EXPECT_NEAR(graph.pose(NodeId{kAll - 1}).translation().y(), 3, 0.02);
  EXPECT_NEAR(graph.pose(NodeId{kAll / 2}).translation().y(), 1.5, 0.1) << "as much where bodies are long";
  const Pose3 within = graph.pose(NodeId{40}).inverse() * graph.pose(NodeId{59});
  EXPECT_TRUE(within.isApprox(poseFromYpr(0.2 * 19, 0, 0, 0, 0, 0), 1e-9));
}

TEST(GraphBuilder, ABodyEndsWhereNothingMeasuresTheMovement) {
  Scenario scenario = wheelsOnly();
  MotionSource gap(kWheelNoise, true);
  for (const StampedPose& seen : scenario.motion.odometry.poses().poses())
    if (seen.t < 14.2 || seen.t > 15.8) gap.add(seen.t, seen.pose, seen.t < 15 ? 0 : 1, Matrix6d::Zero());
  scenario.motion.odometry = gap;
  const KeyPoses poses = scenario.start();
  const FactorGraph graph = buildGraph(poses, scenario.motion, {}, {}, scenario.options, nullptr, 1);
  for (int i = 10; i < 20; ++i) EXPECT_EQ(graph.bodyOf(NodeId{i}) == NodeId{i}, i == 10 || i == 15 || i == 16) << i;
}

// In which the robot may have been carried.
TEST(GraphBuilder, APauseIsOneMovementAndNotSeen) {
  Scenario scenario = wheelsOnly();
  MotionSource paused(kWheelNoise, true);
  for (int t = 0; t < kNodes; ++t)
    if (t < 15 || t > 18) paused.add(t, Pose3::Identity(), 0);
  scenario.motion.odometry = paused;
  const KeyPoses poses = scenario.start();
  EXPECT_EQ(buildGraph(poses, scenario.motion, {}, {}, scenario.options).factors(), 39u + 39u);
  const auto& nodes = poses.nodes();
  EXPECT_TRUE(connected(scenario.motion, nodes[13], nodes[14]));
  EXPECT_FALSE(connected(scenario.motion, nodes[14], nodes[19]));
  EXPECT_TRUE(connected(scenario.motion, nodes[19], nodes[20]));
}

// A handheld camera whose world is tilted: sightings of the floor level it; place and heading of the start
// stay.
TEST(GraphBuilder, FloorLevelsAHandheldCamera) {
  Scenario scenario = wheelsOnly();
  scenario.motion.odometry = MotionSource(MotionNoise{}, false);
  scenario.measurements.planar = false;
  const Pose3 tilt = poseFromYpr(0, 0, 0, 0, 0.15, -0.1), height = poseFromYpr(0, 0, 1.3, 0, 0, 0);
  KeyPoses poses(scenario.motion);
  for (int i = 0; i < 10; ++i) {
    scenario.motion.visual.add(i, truthAt(i), 0, Matrix6d::Zero());
    poses.add(i, tilt * truthAt(i));
    scenario.measurements.grounds.push_back({.node = NodeId{i}, .offset_m = 1.3});
  }
  FactorGraph graph = buildGraph(poses, scenario.motion, scenario.measurements, {}, scenario.options);
  ASSERT_TRUE(graph.optimize(100).usable);
  for (int i = 0; i < 10; ++i) {
    const Pose3 error = (height * truthAt(i)).inverse() * graph.pose(NodeId{i});
    EXPECT_LT(error.translation().norm(), 0.03) << i;
    EXPECT_LT(rotationAngle(error), 0.02) << i;
  }
}

}  // namespace
}  // namespace roomgraph::test
