// SPDX-License-Identifier: BSD-3-Clause
// Probability grid, refinement and score pyramid: derivatives, covariance, corridor, maxima.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>

#include "grid_refinement.h"
#include "score_pyramid.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

using test::asymmetricRoom;
using test::castScan;

ProbabilityGrid mapOf(const std::vector<test::Wall>& walls, const std::vector<Pose2>& poses) {
  std::mt19937 random(3);
  ProbabilityGrid grid(0.05);
  for (const Pose2& pose : poses)
    grid.insert(toPlanarScan(castScan(walls, pose, 0, random), 0.1, 30), pose, {0.6, 0.48});
  return grid;
}

TEST(ProbabilityGrid, PointsThatAreNoneAreOutside) {
  const ProbabilityGrid grid = mapOf(asymmetricRoom(), {{}});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e300, -1e300, 1e10, -1e9})
    for (const Eigen::Vector2d& point : {Eigen::Vector2d(bad, 0), Eigen::Vector2d(0, bad)}) {
      Eigen::Vector2d slope(1, 1);
      EXPECT_EQ(grid.interpolate(point, &slope), static_cast<double>(ProbabilityGrid::kMin)) << bad;
      EXPECT_EQ(slope, Eigen::Vector2d::Zero()) << bad;
      const Eigen::Vector2i cell = grid.cellOf(point);
      EXPECT_FALSE(grid.known(cell.x() + 1, cell.y() + 1)) << bad;
    }
}

TEST(ProbabilityGrid, AScanFromNowhereChangesNothing) {
  ProbabilityGrid grid(0.1);
  grid.insert({{0.05, 0.05}, {{1.05, 0.05}}}, {}, {0.6, 0.4});
  const int width = grid.width();
  grid.insert({{0.05, 0.05}, {{1.05, 0.05}}}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0.6, 0.4});
  EXPECT_EQ(grid.width(), width);
}

TEST(ProbabilityGrid, OneBeamHitsItsEndAndClearsTheWay) {
  ProbabilityGrid grid(0.1);
  const PlanarScan scan{{0.05, 0.05}, {{1.05, 0.05}}};
  grid.insert(scan, {}, {0.6, 0.4});
  const auto p = [&](double x) {
    const Eigen::Vector2i cell = grid.cellOf({x, 0.05});
    return grid.at(cell.x(), cell.y());
  };
  EXPECT_NEAR(p(1.05), 0.6, 1e-6);
  EXPECT_NEAR(p(0.55), 0.4, 1e-6);
  EXPECT_FALSE(grid.known(grid.cellOf({1.15, 0.05}).x(), grid.cellOf({1.15, 0.05}).y()));
  grid.insert(scan, {}, {0.6, 0.4});
  // Odds multiply: (1.5 * 1.5) / (1 + 1.5 * 1.5).
  EXPECT_NEAR(p(1.05), 2.25 / 3.25, 1e-6);
}

TEST(ProbabilityGrid, OneScanChangesACellOnce) {
  ProbabilityGrid grid(0.1);
  // Two returns in one cell, and a beam that passes through it.
  grid.insert({{0.05, 0.05}, {{1.04, 0.05}, {1.06, 0.05}, {2.05, 0.05}}}, {}, {0.6, 0.4});
  const Eigen::Vector2i hit = grid.cellOf({1.05, 0.05}), passed = grid.cellOf({0.55, 0.05});
  EXPECT_NEAR(grid.at(hit.x(), hit.y()), 0.6, 1e-6);
  EXPECT_NEAR(grid.at(passed.x(), passed.y()), 0.4, 1e-6);
}

TEST(ProbabilityGrid, GrowthKeepsWhatWasThere) {
  ProbabilityGrid grid(0.1);
  grid.insert({{0.05, 0.05}, {{1.05, 0.05}}}, {}, {0.6, 0.4});
  grid.insert({{0.05, 0.05}, {{-30.05, -20.05}}}, {}, {0.6, 0.4});
  const Eigen::Vector2i cell = grid.cellOf({1.05, 0.05});
  EXPECT_NEAR(grid.at(cell.x(), cell.y()), 0.6, 1e-6);
}

TEST(ProbabilityGrid, GradientEqualsCentralDifferences) {
  const ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}, {0.3, 0.1, 0.2}});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-3.3, 5.3), y(-2.3, 4.2);
  const double h = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d p(x(random), y(random));
    Eigen::Vector2d gradient;
    grid.interpolate(p, &gradient);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(k);
      EXPECT_NEAR(gradient[k], (grid.interpolate(p + step) - grid.interpolate(p - step)) / (2 * h), 1e-4);
    }
  }
}

TEST(GridCost, GradientEqualsCentralDifferences) {
  const ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}});
  std::mt19937 random(11);
  const Points2 points = toPlanarScan(castScan(asymmetricRoom(), {0.1, 0, 0}, 0, random), 0.1, 30).points;
  PosePrior prior{{0.12, 0.03, -0.02}, 3, 2};
  prior.extra_weight_per_m2 << 2, 0.5, 0.5, 1;
  const Pose2 pose{0.07, -0.02, 0.03};
  const GridCost cost = gridCost(grid, points, pose, prior);
  const double h = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d e = h * Eigen::Vector3d::Unit(k);
    const double up = gridCost(grid, points, {pose.x + e.x(), pose.y + e.y(), pose.yaw + e.z()}, prior).value;
    const double down =
        gridCost(grid, points, {pose.x - e.x(), pose.y - e.y(), pose.yaw - e.z()}, prior).value;
    EXPECT_NEAR(cost.gradient[k], (up - down) / (2 * h), 1e-4) << k;
  }
}

TEST(GridRefinement, FindsThePoseAndItsCovariance) {
  const ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}, {0.1, 0, 0.1}, {0.2, 0.1, 0}});
  std::mt19937 random(5);
  const Pose2 truth{0.3, -0.1, 0.1};
  const Points2 points = toPlanarScan(castScan(asymmetricRoom(), truth, 0, random), 0.1, 30).points;
  const GridRefinement found = refineOnGrid(grid, points, {0.26, -0.06, 0.12}, {});
  EXPECT_NEAR(found.grid_from_scan.x, truth.x, 0.02);
  EXPECT_NEAR(found.grid_from_scan.y, truth.y, 0.02);
  EXPECT_NEAR(found.grid_from_scan.yaw, truth.yaw, 0.01);
  EXPECT_GT(found.explained, 0.9);
  EXPECT_LT(found.contradicted, 0.05);
  const Eigen::Matrix3d covariance = poseCovariance(found, {});
  EXPECT_LT(covariance(0, 0), 0.02 * 0.02);
  EXPECT_LT(covariance(1, 1), 0.02 * 0.02);
}

TEST(GridRefinement, CorridorIsUncertainAlongItsAxis) {
  const ProbabilityGrid grid = mapOf(test::corridor(), {{0, 0, 0}});
  std::mt19937 random(5);
  const Points2 points = toPlanarScan(castScan(test::corridor(), {0.02, 0, 0}, 0, random), 0.1, 30).points;
  const GridRefinement found = refineOnGrid(grid, points, {}, {});
  const Eigen::Matrix3d covariance = poseCovariance(found, {.floor_sigma_m = 1e-4, .floor_sigma_rad = 1e-4});
  EXPECT_GT(covariance(0, 0), 9 * covariance(1, 1));
}

// `says`: what the pyramid is to show; `grid`: what it is made of.
void expectMaxima(const ProbabilityGrid& says, const ProbabilityGrid& grid) {
  const ScorePyramid pyramid(grid, 4);
  for (int level = 0; level < 4; ++level)
    for (int x = -9; x < says.width() + 2; x += 5)
      for (int y = -9; y < says.height() + 2; y += 3) {
        int largest = 0;
        for (int i = 0; i < 1 << level; ++i)
          for (int j = 0; j < 1 << level; ++j)
            largest = std::max(largest, static_cast<int>(says.at(x + i, y + j) * 255.f));
        ASSERT_EQ(pyramid.at(level, x, y), largest) << level << " " << x << " " << y;
      }
}

TEST(ScorePyramid, LevelsAreMaximaOverSquares) {
  ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}});
  expectMaxima(grid, grid);
  const ProbabilityGrid before = grid;
  grid.finish();
  expectMaxima(before, grid);
}

TEST(ScorePyramid, SumsAtCornersAreThoseOfTheCells) {
  const ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}});
  const ScorePyramid pyramid(grid, 4);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> x(-12, grid.width() + 12), y(-12, grid.height() + 12), shift(-9, 9);
  for (int i = 0; i < 200; ++i) {
    std::vector<ScorePyramid::Cell> cells;
    for (int j = 0; j < 20; ++j) cells.push_back({x(random), y(random)});
    const int level = i % 4, side = 1 << level;
    const ScorePyramid::Cell by{shift(random), shift(random)};
    std::array<int, 4> expected{};
    for (const auto& cell : cells)
      for (std::size_t corner = 0; corner < 4; ++corner)
        expected[corner] += pyramid.at(level, cell.x + by.x + (corner < 2 ? 0 : side), cell.y + by.y + (corner % 2 == 0 ? 0 : side));
    EXPECT_EQ(pyramid.sumsAtCorners(level, cells, by, side), expected) << i;
    EXPECT_EQ(pyramid.sum(level, cells, by), expected[0]) << i;
  }
}

TEST(RecentPyramids, AreThoseAskedForLast) {
  std::vector<ProbabilityGrid> grids;
  for (int i = 0; i < 5; ++i) grids.push_back(mapOf(asymmetricRoom(), {{0.3 * i, 0, 0}}));
  RecentPyramids recent(2, 3);
  std::mt19937 random(1);
  std::vector<std::size_t> asked;
  for (int i = 0; i < 60; ++i) {
    const std::size_t number = random() % grids.size();
    std::erase(asked, number);
    asked.push_back(number);
    const ScorePyramid& pyramid = recent.of(number, grids[number]);
    const ScorePyramid fresh(grids[number], 2);
    for (int x = 0; x < grids[number].width(); x += 3)
      for (int y = 0; y < grids[number].height(); y += 3) ASSERT_EQ(pyramid.at(1, x, y), fresh.at(1, x, y));
    for (std::size_t other = 0; other < grids.size(); ++other) {
      const auto place = std::find(asked.rbegin(), asked.rend(), other);
      EXPECT_EQ(recent.holds(other), place < asked.rbegin() + std::min<std::ptrdiff_t>(3, std::ssize(asked))) << i;
    }
  }
}

TEST(FinishedGrid, SaysTheSameToTheLastBit) {
  ProbabilityGrid grid = mapOf(asymmetricRoom(), {{0, 0, 0}, {0.73, 0.21, 0.9}, {-0.4, 0.33, -2}});
  const ProbabilityGrid before = grid;
  grid.finish();
  EXPECT_EQ(grid.corner(), before.corner());
  for (int x = -3; x < before.width() + 3; ++x)
    for (int y = -3; y < before.height() + 3; ++y) {
      ASSERT_EQ(grid.at(x, y), before.at(x, y)) << x << " " << y;
      ASSERT_EQ(grid.known(x, y), before.known(x, y)) << x << " " << y;
    }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-1, 1 + 0.05 * std::max(before.width(), before.height()));
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d point = before.corner() + Eigen::Vector2d(along(random), along(random));
    Eigen::Vector2d slope, slope_before;
    ASSERT_EQ(grid.interpolate(point, &slope), before.interpolate(point, &slope_before)) << point.transpose();
    ASSERT_EQ(slope, slope_before) << point.transpose();
    ASSERT_EQ(grid.cellOf(point), before.cellOf(point));
  }
}

TEST(FinishedGrid, KeepsNothingAroundTheCellsThatWereSeen) {
  ProbabilityGrid grid(0.1);
  grid.insert({{0.05, 0.05}, {{1.05, 0.05}, {0.55, 0.35}}}, {}, {0.6, 0.4});
  grid.finish();
  const Eigen::Vector2i lidar = grid.cellOf({0.05, 0.05});
  const ProbabilityGrid::Block& block = grid.storedBlock();
  EXPECT_EQ(block.x0, lidar.x());
  EXPECT_EQ(block.y0, lidar.y());
  EXPECT_EQ(block.width, 11);
  EXPECT_EQ(block.height, 4);
  EXPECT_THROW(grid.insert({{0.05, 0.05}, {{1.05, 0.05}}}, {}, {0.6, 0.4}), std::logic_error);
}

TEST(FinishedGrid, MayHaveMoreValuesThanCodes) {
  constexpr int kSide = 300;
  std::vector<float> cells;
  for (int i = 0; i < kSide * kSide; ++i) cells.push_back(0.1f + 1e-6f * static_cast<float>(i));
  ProbabilityGrid grid(0.05, {1, 2}, kSide, kSide, cells);
  grid.finish();
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) ASSERT_EQ(grid.at(x, y), cells[static_cast<std::size_t>(y * kSide + x)]);
}

TEST(FinishedGrid, MayBeEmpty) {
  ProbabilityGrid grid(0.1);
  grid.finish();
  EXPECT_FALSE(grid.known(0, 0));
  EXPECT_EQ(grid.interpolate({0.3, 0.2}), static_cast<double>(ProbabilityGrid::kMin));
  EXPECT_EQ(ScorePyramid(grid, 3).at(2, 0, 0), static_cast<int>(ProbabilityGrid::kMin * 255.f));
}

}  // namespace
}  // namespace roomgraph
