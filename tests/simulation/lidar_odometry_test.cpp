// SPDX-License-Identifier: BSD-3-Clause
// Simulated lidar, odometry and detections against geometry and noise models.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "example_world.h"
#include "sensors.h"

namespace roomgraph {
namespace {

constexpr double kPi = std::numbers::pi;

/// Distance from the inside of the example's room (world x in [-1, 5], y in [-2, 2]) to its walls.
double toWall(const Eigen::Vector2d& at, double angle) {
  const double dx = std::cos(angle), dy = std::sin(angle);
  const double tx = dx > 0 ? (5 - at.x()) / dx : dx < 0 ? (-1 - at.x()) / dx : 1e9;
  const double ty = dy > 0 ? (2 - at.y()) / dy : dy < 0 ? (-2 - at.y()) / dy : 1e9;
  return std::min(tx, ty);
}

TEST(LidarCaster, RayLengthsAreExact) {
  World world = test::exampleWorld();
  world.people.clear();
  world.furniture.clear();
  world.rooms[0].doorways.clear();
  const Scene scene(world);
  const LidarCaster caster(scene, 0.25);
  const Pose2 at{1.3, 0.4, 0.7};
  const auto ranges = caster.cast(at, 360, 0);
  for (int i = 0; i < 360; ++i) {
    const double angle = at.yaw - kPi + i * 2 * kPi / 359;
    EXPECT_NEAR(ranges[static_cast<std::size_t>(i)], toWall({at.x, at.y}, angle), 1e-6) << i;
  }
}

TEST(LidarCaster, SeesFurnitureAndPersonsWhereTheyAre) {
  const Scene scene(test::exampleWorld());
  const LidarCaster caster(scene, 0.25);
  const auto range = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to, double t) {
    const double yaw = std::atan2((to - from).y(), (to - from).x());
    return caster.cast({from.x(), from.y(), yaw}, 361, t)[180];
  };
  EXPECT_NEAR(range({0, 0.5}, {4, 0.5}, 0), 3.3, 1e-6);  // front face of the block
  // The person walks from (0, 1.4) to (2, 1.4) at 0.7 m/s: after 2 s its legs are near (1.4, 1.4).
  EXPECT_LT(range({1.4, 0}, {1.4, 1.3}, 2), 1.5);
  EXPECT_NEAR(range({0.3, 0}, {0.3, 1.3}, 2), 2, 1e-6);
}

TEST(MeasureScan, NoiseDropoutsAndLimits) {
  LidarSpec spec;
  spec.beams = 20000;
  std::vector<double> distances(20000, 4.0);
  const auto scan = measureScan(distances, spec, Random(5));
  double sum = 0, squares = 0;
  int valid = 0;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    if (!scan.getScanRangeValidity(i)) continue;
    const double error = scan.getScanRange(i) - 4.0;
    sum += error;
    squares += error * error;
    ++valid;
  }
  EXPECT_NEAR(valid / 20000.0, 0.99, 0.004);
  EXPECT_NEAR(sum / valid, 0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / valid), 0.05, 0.002);
  EXPECT_FALSE(measureScan({9.0}, spec, Random(5)).getScanRangeValidity(0));
  EXPECT_FALSE(measureScan({0.05}, spec, Random(5)).getScanRangeValidity(0));
  EXPECT_FALSE(
      measureScan({std::numeric_limits<double>::infinity()}, spec, Random(5)).getScanRangeValidity(0));
}

std::vector<Pose2> drive() {
  const Scene scene(test::exampleWorld());
  std::vector<Pose2> out;
  for (double t = 0; t < scene.duration(); t += 0.05) out.push_back(planarPart(scene.worldFromRobot(t)));
  return out;
}

TEST(MeasureOdometry, IntegratesToThePathWithoutNoise) {
  const auto truth = drive();
  const auto measured = measureOdometry(truth, {20, 0, 0, 0, 0, 0, 2, 0, 0}, Random(1));
  ASSERT_EQ(measured.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(measured[i].x, truth[i].x, 1e-9);
    EXPECT_NEAR(measured[i].y, truth[i].y, 1e-9);
    EXPECT_NEAR(measured[i].yaw, truth[i].yaw, 1e-9);
  }
}

TEST(MeasureOdometry, ScaleSlipAndDriftAddUp) {
  const auto truth = drive();
  const auto scaled = measureOdometry(truth, {20, 0.05, 0, 0, 0, 0, 0, 0, 0}, Random(1));
  EXPECT_NEAR(scaled.back().x / truth.back().x, 1.05, 1e-6);
  const auto drifted = measureOdometry(truth, {20, 0, 0, 0.1, 0, 0, 0, 0, 0}, Random(1));
  EXPECT_NEAR(drifted.back().yaw, 0.1 * truth.back().x, 1e-3);
  const auto slipped = measureOdometry(truth, {20, 0, 0, 0, 0, 0, 1, 0.3, 0}, Random(1));
  int jumps = 0;
  for (std::size_t i = 1; i < truth.size(); ++i)
    jumps += std::abs((slipped[i].x - slipped[i - 1].x) - (truth[i].x - truth[i - 1].x)) > 1e-6;
  EXPECT_EQ(jumps, 1);
}

TEST(MeasureDetections, JitterMissesFalseAlarmsAndConfusion) {
  const Scene scene(test::exampleWorld());
  const PinholeCamera camera = test::exampleWorld().camera->model;
  int person = 0;
  while (scene.objects()[static_cast<std::size_t>(person)].kind != "person") ++person;
  const ObjectView view{person, 9000, {200, 100, 80, 240}, {200, 100, 80, 240}, 0.9, 0.9, 1, 2.0};
  const auto perfect = measureDetections({view}, scene, camera, {1, 0.25, 20, 0, 0, 0}, Random(1));
  ASSERT_EQ(perfect.items.size(), 1u);
  EXPECT_EQ(perfect.items[0].label, "person");
  EXPECT_EQ(perfect.items[0].u_min, 200);
  EXPECT_EQ(perfect.items[0].v_max, 340);
  int found = 0, wrong = 0, alarms = 0;
  double squares = 0;
  constexpr int kFrames = 4000;
  for (int i = 0; i < kFrames; ++i) {
    const auto out = measureDetections({view}, scene, camera, {0.8, 0.25, 20, 0.05, 0, 0.1},
                                       Random(1, 0, static_cast<std::uint64_t>(i)));
    for (const auto& item : out.items) {
      ++found;
      wrong += item.label != "person";
      squares += (item.v_min - 100) * (item.v_min - 100);
    }
    alarms += static_cast<int>(measureDetections({}, scene, camera, {1, 0.25, 20, 0, 0.3, 0},
                                                 Random(2, 0, static_cast<std::uint64_t>(i)))
                                   .items.size());
  }
  EXPECT_NEAR(found / double{kFrames}, 0.8, 0.03);
  EXPECT_NEAR(wrong / double(found), 0.1 * 5 / 6, 0.02);  // the random label may be the right one
  EXPECT_NEAR(std::sqrt(squares / found), 0.05 * 240, 0.6);
  EXPECT_NEAR(alarms / double{kFrames}, 0.3, 0.03);
  ObjectView hidden = view;
  hidden.visible = 0.1;
  EXPECT_TRUE(measureDetections({hidden}, scene, camera, {1, 0.25, 20, 0, 0, 0}, Random(1)).items.empty());
}

}  // namespace
}  // namespace roomgraph
