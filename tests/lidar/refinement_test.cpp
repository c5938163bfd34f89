// SPDX-License-Identifier: BSD-3-Clause
// Curvature, prior and covariance of grid refinement against closed forms.
#include <gtest/gtest.h>

#include <random>

#include "grid_refinement.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

/// Points every 5 cm on the line y = y0, x in [-length / 2, length / 2].
Points2 lineOfPoints(double y0, double length) {
  Points2 out;
  for (double x = -length / 2; x <= length / 2 + 1e-9; x += 0.05) out.emplace_back(x, y0);
  return out;
}

TEST(SurfaceCurvature, OneWallHoldsItsNormalAndItsTurnOnly) {
  // J^T n n^T J with n = (0, 1): zero in x, one in y, and x^2 in yaw.
  const Points2 wall = lineOfPoints(2, 4);
  const Eigen::Matrix3d grid = Eigen::Vector3d(3, 5, 7).asDiagonal();
  const Eigen::Matrix3d curvature = surfaceCurvature(wall, {}, grid);
  double square = 0;
  for (const auto& p : wall) square += p.x() * p.x() / static_cast<double>(wall.size());
  // The trace in (x, y) is that of the grid.
  EXPECT_NEAR(curvature(0, 0), 0, 1e-6);
  EXPECT_NEAR(curvature(1, 1), 8, 1e-6);
  EXPECT_NEAR(curvature(2, 2), 8 * square, 1e-4);
  EXPECT_NEAR(curvature(0, 2), 0, 1e-6);
  // Turned by 90 degrees it is the x direction that is held.
  const Eigen::Matrix3d turned = surfaceCurvature(wall, {3, 4, M_PI / 2}, grid);
  EXPECT_NEAR(turned(0, 0), 8, 1e-6);
  EXPECT_NEAR(turned(1, 1), 0, 1e-6);
}

// Of several thousand points some are asked for their direction: all say the same.
TEST(SurfaceCurvature, ManyPointsSayWhatSomeOfThemSay) {
  Points2 few, many;
  for (int i = 0; i < 6000; ++i) {
    const double s = i / 6000.0;
    const Eigen::Vector2d p = i % 3 == 0 ? Eigen::Vector2d(2, 6 * s - 3) : Eigen::Vector2d(4 * s - 2, 3);
    many.push_back(p);
    if (i % 10 == 0 || i % 10 == 3) few.push_back(p);
  }
  const Eigen::Matrix3d grid = Eigen::Vector3d(3, 5, 20).asDiagonal();
  const Eigen::Matrix3d all = surfaceCurvature(many, {0.1, 0.2, 0.3}, grid), some = surfaceCurvature(few, {0.1, 0.2, 0.3}, grid);
  EXPECT_LT((all - some).norm(), 0.02 * all.norm());
  EXPECT_GT(all(0, 1) * all(0, 1), 1e-6) << "directions that say nothing prove nothing";
}

TEST(SurfaceCurvature, LonelyPointsSayNothing) {
  const Eigen::Matrix3d grid = Eigen::Vector3d(3, 5, 7).asDiagonal();
  EXPECT_EQ(surfaceCurvature({{1, 0}, {5, 5}, {-4, 2}}, {}, grid), grid);
  EXPECT_EQ(surfaceCurvature({{1, 0}, {1.05, 0}, {1.1, 0.01}}, {}, grid), grid) << "three are too few";
  Points2 wall = lineOfPoints(2, 4);
  const Eigen::Matrix3d before = surfaceCurvature(wall, {}, grid);
  wall.emplace_back(0, -9);
  EXPECT_LT((surfaceCurvature(wall, {}, grid) - before).norm(), 1e-6);
}

TEST(PoseCovariance, IsTheInverseCurvatureBoundedAndWithAFloor) {
  GridRefinement found;
  found.residual_variance = 0.04;
  found.curvature = Eigen::Vector3d(400, 1e-9, 100).asDiagonal();
  const CovarianceModel model{.inflation = 2, .floor_sigma_m = 0.1, .floor_sigma_rad = 0.2, .max_sigma = 3};
  const Eigen::Matrix3d covariance = poseCovariance(found, model);
  // 1 / (400 / (0.04 * 4) + 1 / 9) + 0.01, 9 + 0.01, 1 / (100 / 0.16 + 1 / 9) + 0.04.
  EXPECT_NEAR(covariance(0, 0), 1 / (2500 + 1 / 9.0) + 0.01, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 9.01, 1e-6);
  EXPECT_NEAR(covariance(2, 2), 1 / (625 + 1 / 9.0) + 0.04, 1e-12);
  EXPECT_EQ(covariance, covariance.transpose());
}

TEST(GridRefinement, ThePriorDecidesWhatTheScanDoesNot) {
  std::mt19937 random(3);
  ProbabilityGrid grid(0.05);
  grid.insert(toPlanarScan(test::castScan(test::corridor(), {}, 0, random, 0), 0.1, 15), {}, {0.7, 0.4});
  const Points2 points =
      toPlanarScan(test::castScan(test::corridor(), {}, 0, random, 0), 0.1, 15).points;
  PosePrior prior{{0.3, 0.3, 0}, 0, 0};
  prior.extra_weight_per_m2 << 100, 0, 0, 0;
  const Pose2 found = refineOnGrid(grid, points, {0.2, 0.03, 0.02}, prior).grid_from_scan;
  EXPECT_NEAR(found.x, 0.3, 0.02) << "along the corridor: the prior";
  EXPECT_NEAR(found.y, 0, 0.035) << "across: the scan";
  EXPECT_NEAR(found.yaw, 0, 0.01);
}

TEST(GridRefinement, CountsWhatTheGridExplainsAndContradicts) {
  ProbabilityGrid grid(0.05);
  PlanarScan wall;
  for (const auto& p : lineOfPoints(2, 3)) wall.points.push_back(p);
  for (int i = 0; i < 5; ++i) grid.insert(wall, {}, {0.7, 0.3});
  // Ten on the wall, six in front of it where beams went through, four behind it where nobody looked.
  Points2 points;
  for (int i = 0; i < 10; ++i) points.emplace_back(-0.5 + 0.1 * i, 2);
  for (int i = 0; i < 6; ++i) points.emplace_back(0, 0.8 + 0.1 * i);
  for (int i = 0; i < 4; ++i) points.emplace_back(0.1 * i, 3);
  const GridRefinement out = refineOnGrid(grid, points, {}, {{}, 1e6, 1e6});
  EXPECT_NEAR(out.explained, 0.5, 1e-12);
  EXPECT_NEAR(out.contradicted, 0.3, 1e-12);
}

}  // namespace
}  // namespace roomgraph
