// SPDX-License-Identifier: BSD-3-Clause
// Parts of the calibration: paths, walls in scans, turn rates, wheels, and derivatives.
#include <ceres/autodiff_cost_function.h>
#include <gmock/gmock.h>

#include <random>

#include "made_up_drive.h"
#include "roomgraph/datasets/calibration_file.h"
#include "sensor_costs.h"
#include "turn_rates.h"

namespace roomgraph::test {
namespace {

TEST(PlanarPath, FollowsACurve) {
  PlanarPath path;
  const auto curve = [](double t) { return Pose2{std::sin(t), 1 - std::cos(t), wrapAngle(3 + t)}; };
  for (double t = 0; t < 6; t += 0.1 + 0.03 * std::sin(9 * t)) ASSERT_TRUE(path.add(t, curve(t)));
  EXPECT_FALSE(path.add(path.time(path.size() - 1), {}));
  path.smooth();
  for (double t = 0.5; t < 5; t += 0.037) {
    EXPECT_NEAR(path.at(t)[0], std::sin(t), 1e-4) << t;
    EXPECT_NEAR(wrapAngle(path.at(t)[2] - 3 - t), 0, 1e-6) << "unwrapped over pi";
  }
  EXPECT_TRUE(path.covers(0.5, 0.5));
  EXPECT_FALSE(path.covers(0.4, 0.5));
  // Derivative with respect to time against finite differences.
  using J = ceres::Jet<double, 1>;
  for (double t = 0.52; t < 5; t += 0.31)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(path.at(J(t, 0))[k].v[0], (path.at(t + 1e-6)[k] - path.at(t - 1e-6)[k]) / 2e-6, 1e-5);
}

// Between poses and at them the curve has about the same noise.
TEST(PlanarPath, SmoothsNoise) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.01);
  double at_poses = 0, between = 0;
  int count = 0;
  for (int n = 0; n < 200; ++n) {
    PlanarPath path;
    for (int i = 0; i < 40; ++i) path.add(0.1 * i, {0.03 * i + noise(random), 0, 0});
    path.smooth();
    for (int i = 10; i < 30; ++i, ++count) {
      at_poses += std::pow(path.at(0.1 * i)[0] - 0.03 * i, 2);
      between += std::pow(path.at(0.1 * i + 0.05)[0] - 0.03 * (i + 0.5), 2);
    }
  }
  EXPECT_LT(std::sqrt(at_poses / count), 0.009);
  EXPECT_NEAR(between / at_poses, 1, 0.15);
}

// A stretch without poses is bridged by a straight line.
TEST(PlanarPath, BridgesGaps) {
  PlanarPath path;
  for (int i = 0; i < 60; ++i)
    if (i < 20 || i > 40) path.add(0.1 * i, {0.02 * i, 1, 0});
  path.smooth();
  EXPECT_NEAR(path.at(3.0)[0], 0.6, 1e-3);
}

TEST(PlanarPath, MovementsAreThoseOfPoses) {
  const Pose2 a{1, 2, 0.7}, b{-0.5, 1, 2.9};
  const Pose2 expected = a.inverse() * b, product = a * b;
  const auto between = planarBetween<double>({1, 2, 0.7}, {-0.5, 1, 2.9});
  const auto together = planarProduct<double>({1, 2, 0.7}, {-0.5, 1, 2.9});
  EXPECT_NEAR(between[0], expected.x, 1e-12);
  EXPECT_NEAR(between[1], expected.y, 1e-12);
  EXPECT_NEAR(between[2], expected.yaw, 1e-12);
  EXPECT_NEAR(together[0], product.x, 1e-12);
  EXPECT_NEAR(together[1], product.y, 1e-12);
}

TEST(ScanWalls, AreThoseOfARoomWithATable) {
  // Walls 2 m ahead and 1.5 m to the left, and a narrow thing before one of them.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.008);
  std::vector<Eigen::Vector2d> returns;
  for (double angle = -40 * kDegree; angle < 120 * kDegree; angle += kDegree) {
    const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
    double range = std::min(ray.x() > 0.01 ? 2 / ray.x() : 99, ray.y() > 0.01 ? 1.5 / ray.y() : 99);
    if (std::abs(angle + 20 * kDegree) < 3 * kDegree) range = 1;
    returns.emplace_back((range + noise(random)) * ray);
  }
  const auto walls = findScanWalls(returns);
  ASSERT_GE(walls.size(), 2u);
  int ahead = 0, left = 0;
  for (const auto& wall : walls) {
    const bool is_ahead = wall.normal.x() < -0.9;
    (is_ahead ? ahead : left)++;
    EXPECT_NEAR(wall.distance_m, is_ahead ? -2 : -1.5, 0.02);
    EXPECT_NEAR(std::abs(is_ahead ? wall.normal.y() : wall.normal.x()), 0, 0.05);
    EXPECT_LT(wall.sigma_m, 0.006);
    EXPECT_GT(wall.to_m - wall.from_m, 0.4);
  }
  EXPECT_GE(ahead, 1);
  EXPECT_EQ(left, 1);
}

TEST(ScanWalls, StandardDeviationsAreThoseOfManyScans) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  double squares = 0, stated = 0;
  constexpr int kScans = 400;
  for (int n = 0; n < kScans; ++n) {
    std::vector<Eigen::Vector2d> returns;
    for (int i = 0; i < 40; ++i) returns.emplace_back(2 + noise(random), -1 + 0.05 * i);
    const auto walls = findScanWalls(returns);
    ASSERT_EQ(walls.size(), 1u);
    const double at_end = (2 * walls[0].normal.x() + 0.9 * walls[0].normal.y()) - walls[0].distance_m;
    squares += at_end * at_end / kScans;
    stated += std::pow(walls[0].sigmaAt(walls[0].along.dot(Eigen::Vector2d(2, 0.9))), 2) / kScans;
  }
  EXPECT_NEAR(std::sqrt(stated / squares), 1, 0.15);
}

TEST(ScanWalls, NeedLengthAndReturns) {
  std::vector<Eigen::Vector2d> few, apart;
  for (int i = 0; i < 7; ++i) few.emplace_back(1, 0.1 * i);
  for (int i = -6; i <= 6; ++i) apart.emplace_back(1, 0.3 * i);
  EXPECT_TRUE(findScanWalls(few).empty());
  EXPECT_TRUE(findScanWalls(apart).empty());
  EXPECT_TRUE(findScanWalls({}).empty());
}

TEST(TurnRates, TellTheOffsetBetweenClocks) {
  const auto rate = [](double t) { return 0.4 * std::sin(t) + 0.3 * std::sin(2.7 * t + 1); };
  const TurnRate reference = [&](double t) {
    return t < 0 || t > 60 ? std::nullopt : std::optional(rate(t));
  };
  for (const double late : {0.0, 0.083, -0.21}) {
    const TurnRate moved = [&](double t) -> std::optional<double> { return 1.1 * rate(t + late); };
    const auto offset = turnRateOffset(reference, moved, 0, 60);
    ASSERT_TRUE(offset);
    EXPECT_NEAR(*offset, late, 0.002);
  }
  const TurnRate still = [](double) { return std::optional(0.001); };
  EXPECT_FALSE(turnRateOffset(still, still, 0, 60)) << "no turning";
  const TurnRate other = [&](double t) { return std::optional(0.4 * std::cos(11 * t)); };
  EXPECT_FALSE(turnRateOffset(reference, other, 0, 60)) << "not alike";
  EXPECT_FALSE(turnRateOffset(reference, reference, 0, 1)) << "too short";
}

TEST(SensorModel, WheelsAreCorrectedAsInTheCalibrationFile) {
  const ParameterVector p = trueParameters();
  for (const Pose2 read : {Pose2{0.3, 0.02, 0.1}, Pose2{0.05, 0, -1.2}, Pose2{0.4, 0, 0}, Pose2{0, 0, 0.5}}) {
    const Pose2 expected = corrected(read, {p[kWheelScale], p[kTurnScale], p[kHeadingDrift]});
    const auto result = correctedMovement<double>(p.data(), {read.x, read.y, read.yaw});
    EXPECT_NEAR(result[0], expected.x, 1e-9);
    EXPECT_NEAR(result[1], expected.y, 1e-9);
    EXPECT_NEAR(result[2], expected.yaw, 1e-9);
  }
}

TEST(SensorModel, MovementOfTheRobotIsThatOfTheLidarSeenFromTheRobot) {
  const ParameterVector p = trueParameters();
  const Pose2 lidar{p[kLidarX], p[kLidarY], p[kLidarYaw]}, moved{0.2, -0.1, 0.4};
  const Pose2 expected = lidar * moved * lidar.inverse();
  const auto result = robotMovement<double>(p.data(), {0.2, -0.1, 0.4});
  EXPECT_NEAR(result[0], expected.x, 1e-12);
  EXPECT_NEAR(result[1], expected.y, 1e-12);
  EXPECT_NEAR(result[2], expected.yaw, 1e-12);
}

// Analytic derivatives against central differences, at a calibration that is not the truth.
void expectDerivatives(const ceres::CostFunction& cost, std::vector<std::vector<double>> blocks) {
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  const int rows = cost.num_residuals();
  std::vector<std::vector<double>> jacobians;
  std::vector<double*> places;
  for (const auto& block : blocks) jacobians.emplace_back(static_cast<std::size_t>(rows) * block.size());
  for (auto& jacobian : jacobians) places.push_back(jacobian.data());
  std::vector<double> residuals(static_cast<std::size_t>(rows)), low = residuals, high = residuals;
  ASSERT_TRUE(cost.Evaluate(pointers.data(), residuals.data(), places.data()));
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t i = 0; i < blocks[b].size(); ++i) {
      const double before = blocks[b][i], step = 1e-6;
      blocks[b][i] = before - step;
      cost.Evaluate(pointers.data(), low.data(), nullptr);
      blocks[b][i] = before + step;
      cost.Evaluate(pointers.data(), high.data(), nullptr);
      blocks[b][i] = before;
      for (std::size_t r = 0; r < residuals.size(); ++r) {
        const double numeric = (high[r] - low[r]) / (2 * step);
        EXPECT_NEAR(jacobians[b][r * blocks[b].size() + i], numeric, 1e-4 * (1 + std::abs(numeric)))
            << "block " << b << " parameter " << i << " residual " << r;
      }
    }
}

std::vector<double> listed(const ParameterVector& p) {
  return {p.data(), p.data() + p.size()};
}

WheelMovement movementOf(const RecordingEvidence& evidence, std::size_t from, std::size_t to) {
  const PlanarPath& wheels = evidence.wheels[0];
  WheelMovement out{&evidence.lidar[0], wheels.time(from), wheels.time(to), {}};
  for (std::size_t i = from; i < to; ++i)
    out.read.push_back(planarBetween(wheels.values(i), wheels.values(i + 1)));
  return out;
}

TEST(SensorCosts, DerivativesAreThoseOfFiniteDifferences) {
  MadeUpDrive drive({.seconds = 6});
  const auto evidence = drive.evidence();
  const auto wrong = listed(wrongParameters());
  const auto matches = matchWalls(evidence, trueParameters(), MadeUpDrive::kLidarZ, {});
  ASSERT_FALSE(matches.empty());
  expectDerivatives(ceres::AutoDiffCostFunction<WallCost, 1, kParameterCount>(
                        new WallCost{&evidence.lidar[0], matches[matches.size() / 2], 0.01}),
                    {wrong});
  expectDerivatives(ceres::AutoDiffCostFunction<FloorCost, 1, kParameterCount>(
                        new FloorCost{evidence.views[3].floor.at(1), 0.01}),
                    {wrong});
  expectDerivatives(ceres::AutoDiffCostFunction<CameraStepCost, 6, kParameterCount>(
                        new CameraStepCost{&evidence.lidar[0], evidence.steps[4], 0.02, 0.1, 0.1}),
                    {wrong});
  MadeUpDrive before_board({.seconds = 20, .board = true});
  const auto boards = before_board.evidence();
  ASSERT_GE(boards.boards.size(), 2u);
  const Eigen::Matrix3d skewed = (Eigen::Matrix3d() << 9, 0, 0, 3, 7, 0, -2, 1, 12).finished();
  expectDerivatives(
      ceres::AutoDiffCostFunction<BoardCost, 6, kParameterCount>(
          new BoardCost{&boards.lidar[0], boards.boards.front(), boards.boards.back(), 0.02, skewed, skewed}),
      {wrong});
  expectDerivatives(
      ceres::AutoDiffCostFunction<BoardDepthCost, 1, kParameterCount>(new BoardDepthCost{boards.boards[1], 0.01}), {wrong});
  const WheelMovement movement = movementOf(evidence, 40, 64);
  expectDerivatives(ceres::AutoDiffCostFunction<WheelMoveCost, 2, kParameterCount>(
                        new WheelMoveCost{movement, 0.1, 0.1}),
                    {wrong});
  expectDerivatives(
      ceres::AutoDiffCostFunction<WheelTurnCost, 1, kParameterCount>(new WheelTurnCost{movement, 0.1}),
      {wrong});
}

// At the truth nothing is left of exact data.
TEST(SensorCosts, AreZeroAtTheTruth) {
  MadeUpDrive drive({.seconds = 8});
  const auto evidence = drive.evidence();
  const ParameterVector p = trueParameters();
  for (const auto& match : matchWalls(evidence, p, MadeUpDrive::kLidarZ, {})) {
    double off = 0;
    WallCost{&evidence.lidar[0], match, 1}(p.data(), &off);
    EXPECT_NEAR(off, 0, 1e-3);
  }
  for (const auto& view : evidence.views)
    for (const auto& patch : view.floor) {
      double off = 0;
      FloorCost{patch, 1}(p.data(), &off);
      EXPECT_NEAR(off, 0, 1e-9);
    }
  for (const auto& step : evidence.steps) {
    std::array<double, 6> off{};
    CameraStepCost{&evidence.lidar[0], step, p[kCameraTime], 1, 1}(p.data(), off.data());
    for (const double value : off) EXPECT_NEAR(value, 0, 1e-3);
  }
  MadeUpDrive before_board({.seconds = 20, .board = true});
  const auto boards = before_board.evidence();
  for (const auto& view : boards.boards) {
    std::array<double, 6> off{};
    const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
    BoardCost{&boards.lidar[0], boards.boards.front(), view, p[kCameraTime], unit, unit}(p.data(), off.data());
    for (const double value : off) EXPECT_NEAR(value, 0, 2e-3);
    double depth = 0;
    BoardDepthCost{view, 1}(p.data(), &depth);
    EXPECT_NEAR(depth, 0, 1e-9);
  }
  for (std::size_t i = 10; i + 34 < evidence.wheels[0].size(); i += 6)
    for (const double value : movementOf(evidence, i, i + 24).difference(p.data(), p[kWheelTime]))
      EXPECT_NEAR(value, 0, 2e-3);
}

}  // namespace
}  // namespace roomgraph::test
