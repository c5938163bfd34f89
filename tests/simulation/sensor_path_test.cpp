// SPDX-License-Identifier: BSD-3-Clause
// SensorPath: speed limits, waypoints, closed and hand-held paths.
#include "sensor_path.h"

#include <gtest/gtest.h>

#include <numbers>

namespace roomgraph {
namespace {

RobotPathSpec lShape() {
  RobotPathSpec spec;
  spec.path_m = {{0, 0}, {2, 0}, {4, 0.5}, {4.5, 2}, {4, 4}};
  return spec;
}

TEST(SensorPath, KeepsTheLimits) {
  const RobotPathSpec spec = lShape();
  const SensorPath path(spec);
  constexpr double kStep = 0.05;
  double last_speed = 0;
  for (double t = 0; t + kStep <= path.duration(); t += kStep) {
    const Pose3 step = path.at(t).inverse() * path.at(t + kStep);
    const double speed = step.translation().norm() / kStep;
    EXPECT_LT(speed, spec.max_speed_m_s * 1.001) << t;
    EXPECT_LT(rotationAngle(step) / kStep, spec.max_turn_rad_s * 1.1) << t;
    EXPECT_LT(std::abs(speed - last_speed) / kStep, spec.acceleration_m_s2 * 1.2) << t;
    // A differential drive cannot move sideways.
    EXPECT_LT(std::abs(step.translation().y()), 0.02 * kStep) << t;
    last_speed = speed;
  }
}

TEST(SensorPath, TurnsNoFasterWhereItGoesBackTheSameWay) {
  RobotPathSpec spec;
  spec.path_m = {{0, 0}, {1, 0}, {2, 0}, {1, 0}, {0.5, 0.5}, {0, 0}};
  const SensorPath path(spec);
  double turned = 0;
  for (double t = 0; t + 0.05 <= path.duration(); t += 0.05) {
    const double angle = rotationAngle(path.at(t).inverse() * path.at(t + 0.05));
    EXPECT_LT(angle / 0.05, spec.max_turn_rad_s * 1.3) << t;
    turned += angle;
  }
  EXPECT_GT(turned, 1.5 * std::numbers::pi) << "180 degrees at (2, 0), then 45 and 90";
}

TEST(SensorPath, TurnsOnTheSpotWhereAStraightWayEnds) {
  RobotPathSpec spec;
  spec.path_m = {{0, 0}, {1, 0}, {2, 0}, {1, 0}, {0, 0}};
  const SensorPath path(spec);
  double turned = 0;
  for (double t = 0; t + 0.03 < path.duration(); t += 0.03) {
    const Pose3 step = path.at(t).inverse() * path.at(t + 0.03);
    EXPECT_LT(rotationAngle(step) / 0.03, spec.max_turn_rad_s * 1.05) << t;
    EXPECT_LT(step.translation().norm() / 0.03, spec.max_speed_m_s * 1.05) << t;
    const bool turns = rotationAngle(step) > 0.003;
    EXPECT_TRUE(!turns || step.translation().norm() < 0.003) << t;
    turned += rotationAngle(step);
  }
  EXPECT_NEAR(turned, std::numbers::pi, 0.05);
  EXPECT_GT(path.duration(), 4 / spec.max_speed_m_s + std::numbers::pi / spec.max_turn_rad_s);
}

TEST(SensorPath, PassesNearItsPointsFromTheFirstToTheLast) {
  const RobotPathSpec spec = lShape();
  const SensorPath path(spec);
  EXPECT_LT((path.at(0).translation().head<2>() - spec.path_m.front()).norm(), 1e-9);
  EXPECT_LT((path.at(1e9).translation().head<2>() - spec.path_m.back()).norm(), 0.03);
  for (const auto& point : spec.path_m) {
    double nearest = 1e9;
    for (double t = 0; t <= path.duration(); t += 0.02)
      nearest = std::min(nearest, (path.at(t).translation().head<2>() - point).norm());
    EXPECT_LT(nearest, 0.08) << point.transpose();
  }
}

TEST(SensorPath, AClosedPathComesHome) {
  RobotPathSpec spec = lShape();
  spec.closed = true;
  spec.path_m.emplace_back(0, 3);
  const SensorPath path(spec);
  EXPECT_LT((path.at(path.duration()).translation() - path.at(0).translation()).norm(), 0.03);
}

TEST(SensorPath, AHandHeldCameraLooksWhereToldAndMovesInAllDirections) {
  HandheldSpec spec;
  spec.keys = {{{0, 0, 1.2}, {3, 0, 1.0}}, {{1, 0.4, 1.5}, {3, 0, 0.5}}, {{2, 0, 1.3}, {3, 3, 1.0}}};
  const SensorPath path(spec);
  const Eigen::Vector3d forward = path.at(0).linear().col(0);
  EXPECT_GT(forward.dot((spec.keys[0].look_at_m - spec.keys[0].at_m).normalized()), std::cos(0.03));
  double low = 9, high = 0, roll = 0;
  for (double t = 0; t < path.duration(); t += 0.05) {
    low = std::min(low, path.at(t).translation().z());
    high = std::max(high, path.at(t).translation().z());
    roll = std::max(roll, std::abs(path.at(t).linear()(2, 1)));
    EXPECT_LT(rotationAngle(path.at(t).inverse() * path.at(t + 0.02)) / 0.02, 0.8);
  }
  EXPECT_GT(high - low, 0.2);
  EXPECT_GT(roll, 0.01);
}

}  // namespace
}  // namespace roomgraph
