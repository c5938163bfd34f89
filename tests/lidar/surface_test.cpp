// SPDX-License-Identifier: BSD-3-Clause
// Lines of surface cells against principal axes, sides of thin walls, and errors of refined scans against their covariance.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <random>

#include "surface_refinement.h"
#include "synthetic_scans.h"

namespace roomgraph {
namespace {

constexpr double kCell_m = 0.1;

FacedScan facing(const Points2& points, double direction_rad) {
  return {points, std::vector<double>(points.size(), direction_rad)};
}

PlanarScan seenFrom(const std::vector<test::Wall>& walls, const Pose2& pose, std::mt19937& random, double sigma_m) {
  return toPlanarScan(test::castScan(walls, pose, 0, random, sigma_m), 0.1, 30);
}

TEST(SurfaceCells, TheLineIsThePrincipalAxisOfTheReturnsAround) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  std::uniform_real_distribution<double> along(-0.6, 0.6);
  const Eigen::Vector2d direction = Eigen::Vector2d(2, 1).normalized(), normal(-direction.y(), direction.x());
  Points2 points;
  for (int i = 0; i < 300; ++i) points.push_back(Eigen::Vector2d(3.02, -7.4) + along(random) * direction + noise(random) * normal);
  SurfaceCells cells(kCell_m);
  cells.insert(facing(points, 2));
  const Eigen::Vector2d at(3.05, -7.36);
  const auto line = cells.around(at, 2.3);
  ASSERT_TRUE(line);
  // The same by hand: mean and eigenvectors of the points in the 3 x 3 cells.
  const Eigen::Array2d low = (at / kCell_m).array().floor() * kCell_m - kCell_m, high = low + 3 * kCell_m;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Points2 inside;
  for (const auto& p : points)
    if ((p.array() >= low).all() && (p.array() < high).all()) inside.push_back(p), mean += p;
  mean /= static_cast<double>(inside.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const auto& p : inside) covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(inside.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  EXPECT_LT((line->mean - mean).norm(), 1e-5);
  EXPECT_NEAR(std::abs(line->normal.dot(axes.eigenvectors().col(0))), 1, 1e-5);
  EXPECT_NEAR(line->variance_m2, axes.eigenvalues()[0], 1e-7);
}

TEST(SurfaceCells, NoLineOfFewReturnsAndOfAHeap) {
  SurfaceCells cells(kCell_m);
  cells.insert(facing({{0.01, 0.05}, {0.03, 0.05}, {0.05, 0.05}, {0.07, 0.05}, {0.09, 0.05}}, 0));
  EXPECT_FALSE(cells.around({0.05, 0.05}, 0)) << "five are too few";
  cells.insert(facing({{0.11, 0.05}}, 0));
  EXPECT_TRUE(cells.around({0.05, 0.05}, 0));
  std::mt19937 random(6);
  std::normal_distribution<double> spread(0, 0.05);
  Points2 heap;
  for (int i = 0; i < 100; ++i) heap.emplace_back(5 + spread(random), 5 + spread(random));
  cells.insert(facing(heap, 0));
  EXPECT_FALSE(cells.around({5, 5}, 0));
  EXPECT_FALSE(cells.around({-20, 3}, 0)) << "nothing there";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  cells.insert(facing(Points2(10, Eigen::Vector2d(nan, 1e300)), 0));
  EXPECT_FALSE(cells.around({nan, 0}, 0));
  EXPECT_FALSE(cells.around({1e300, 0}, 0));
}

TEST(SurfaceCells, TheTwoSidesOfAThinWallStayTwoLines) {
  SurfaceCells cells(kCell_m);
  Points2 near, far;
  for (double y = -1; y < 1; y += 0.01) near.emplace_back(2, y), far.emplace_back(2.08, y);
  cells.insert(facing(near, M_PI));
  cells.insert(facing(far, 0));
  EXPECT_NEAR(cells.around({2.04, 0}, M_PI)->mean.x(), 2, 1e-5);
  EXPECT_NEAR(cells.around({2.04, 0}, 0)->mean.x(), 2.08, 1e-5);
  EXPECT_NEAR(cells.around({2.04, 0}, 0.6)->mean.x(), 2.08, 1e-5) << "seen at a slant";
  EXPECT_FALSE(cells.around({2.04, 0}, M_PI / 2)) << "nothing faces that way";
}

TEST(FacedScan, ReturnsOfARoomFaceTheLidarAlongTheirWallsNormals) {
  std::mt19937 random(7);
  const auto room = test::boxAt(-3, -2, 6, 4);
  const Pose2 pose{0.5, 0.3, 0.4};
  const FacedScan scan = transformed(pose, faced(seenFrom(room, pose, random, 0)));
  int checked = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector2d p = scan.points[i];
    const double to_x = 3 - std::abs(p.x()), to_y = 2 - std::abs(p.y());
    if (std::max(to_x, to_y) < 0.6) continue;  // at a corner two walls mix
    const Eigen::Vector2d inwards = to_x < to_y ? Eigen::Vector2d(-p.x(), 0).normalized() : Eigen::Vector2d(0, -p.y()).normalized();
    EXPECT_NEAR(wrapAngle(scan.facing_rad[i] - std::atan2(inwards.y(), inwards.x())), 0, 0.02) << p.transpose();
    ++checked;
  }
  EXPECT_GT(checked, 250);
}

// A map of twenty scans at known poses, and a scan to be placed in it.
class Refinement : public ::testing::Test {
 protected:
  void map(const std::vector<test::Wall>& walls, double sigma_m) {
    for (int i = 0; i < 20; ++i) insert({0.05 * i - 0.5, 0.02 * i, 0.05 * i}, walls, sigma_m);
  }
  void insert(const Pose2& pose, const std::vector<test::Wall>& walls, double sigma_m) {
    const PlanarScan scan = seenFrom(walls, pose, random, sigma_m);
    grid.insert(scan, pose, {0.6, 0.48});
    surfaces.insert(transformed(pose, faced(scan)));
  }
  GridRefinement onGrid(const PlanarScan& scan, const Pose2& start) const {
    return refineOnGrid(grid, thinnedTo(scan.points, 0.05, 200), start, {});
  }
  std::mt19937 random{8};
  ProbabilityGrid grid{0.05};
  LocalSurfaces surfaces{0.05};
};

TEST_F(Refinement, FinishedSurfacesAreTheSameToTheLastBit) {
  map(test::asymmetricRoom(), 0.02);
  const LocalSurfaces before = surfaces;
  surfaces.finish();
  std::uniform_real_distribution<double> along(-6, 6), facing_rad(-M_PI, M_PI);
  int lines = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d point(along(random), along(random));
    const double direction = facing_rad(random);
    const auto line = surfaces.around(point, direction), same = before.around(point, direction);
    ASSERT_EQ(line.has_value(), same.has_value()) << point.transpose();
    if (!line) continue;
    ++lines;
    ASSERT_EQ(line->mean, same->mean);
    ASSERT_EQ(line->normal, same->normal);
    ASSERT_EQ(line->variance_m2, same->variance_m2);
  }
  EXPECT_GT(lines, 300);
  EXPECT_THROW(surfaces.insert(facing({{1, 1}}, 0)), std::logic_error);
}

TEST_F(Refinement, LinesOfReturnsThatMoveAreThoseOfTheirPlaces) {
  map(test::asymmetricRoom(), 0.02);
  FacedScan scan = faced(seenFrom(test::asymmetricRoom(), {}, random, 0.02));
  scan.points.push_back({std::numeric_limits<double>::quiet_NaN(), 0});
  scan.facing_rad.push_back(std::numeric_limits<double>::quiet_NaN());
  LinesOfReturns lines(surfaces, scan.points.size());
  std::normal_distribution<double> step(0, 0.02);
  Pose2 pose;
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    const int levels = 1 + static_cast<int>(random() % LocalSurfaces::kAll);
    const FacedScan placed = transformed(pose, scan);
    for (std::size_t j = 0; j < placed.points.size(); ++j) {
      const auto expected = surfaces.around(placed.points[j], placed.facing_rad[j], levels);
      const SurfaceLine* line = lines.around(j, placed.points[j], placed.facing_rad[j], levels);
      ASSERT_EQ(line != nullptr, expected.has_value()) << i << " " << j;
      if (!line) continue;
      ++found;
      ASSERT_EQ(line->mean, expected->mean);
      ASSERT_EQ(line->normal, expected->normal);
      ASSERT_EQ(line->variance_m2, expected->variance_m2);
    }
    pose = {pose.x + step(random), pose.y + step(random), pose.yaw + step(random)};
  }
  EXPECT_GT(found, 1000);
}

TEST_F(Refinement, ErrorsAreAsLargeAsTheirCovarianceSaysAndSmallerThanThoseOfTheGrid) {
  const double sigma_m = 0.02;
  map(test::asymmetricRoom(), sigma_m);
  const Pose2 truth{0.3, 0.2, 0.6};
  const int trials = 300;
  double normalised = 0, squared_m = 0, grid_squared_m = 0;
  for (int i = 0; i < trials; ++i) {
    const PlanarScan scan = seenFrom(test::asymmetricRoom(), truth, random, sigma_m);
    const GridRefinement start = onGrid(scan, {0.32, 0.19, 0.61});
    const auto fit = refineOnSurfaces(surfaces, faced(scan), start, {});
    ASSERT_TRUE(fit);
    const Eigen::Vector3d error(fit->map_from_scan.x - truth.x, fit->map_from_scan.y - truth.y,
                                wrapAngle(fit->map_from_scan.yaw - truth.yaw));
    normalised += error.dot(fit->information * error) / trials;
    squared_m += error.head<2>().squaredNorm() / trials;
    grid_squared_m += Eigen::Vector2d(start.grid_from_scan.x - truth.x, start.grid_from_scan.y - truth.y).squaredNorm() / trials;
  }
  // Three of them are expected; the map's own error, the same in all trials, is in it too.
  EXPECT_GT(normalised, 3 * 0.5);
  EXPECT_LT(normalised, 3 * 1.5);
  EXPECT_LT(squared_m, 0.5 * grid_squared_m);
  EXPECT_LT(std::sqrt(squared_m), 0.003);
}

// Ten times the beams on walls that are near: their returns err alike, and know little more than a tenth of them.
TEST_F(Refinement, ReturnsThatLieCloseTogetherCountLittleMoreThanOne) {
  map(test::corridor(), 0.005);
  const auto informationOf = [&](int beams) {
    const PlanarScan scan = toPlanarScan(test::castScan(test::corridor(), {}, 0, random, 0.005, beams), 0.1, 30);
    const auto fit = refineOnSurfaces(surfaces, faced(scan), onGrid(scan, {}), {});
    EXPECT_TRUE(fit);
    return fit ? fit->information(1, 1) : 0;
  };
  const double sparse = informationOf(90), usual = informationOf(360), dense = informationOf(3600);
  EXPECT_GT(usual, 1.3 * sparse) << "of beams that lie apart each counts";
  EXPECT_LT(dense, 3 * usual);
  EXPECT_GT(dense, usual);
}

// Beams that err on their own, as a simulation's: that they do is learnt from them, and then each of them counts.
TEST_F(Refinement, ReturnsThatErrOnTheirOwnCountEach) {
  map(test::corridor(), 0.02);
  OwnShare own;
  const auto informationOf = [&] {
    const PlanarScan scan = toPlanarScan(test::castScan(test::corridor(), {}, 0, random, 0.02, 1440), 0.1, 30);
    GridRefinement found = onGrid(scan, {});
    refineFurther(surfaces, faced(scan), {}, own, found);
    EXPECT_TRUE(found.on_surfaces);
    return found.curvature(1, 1);
  };
  const double before = informationOf();
  for (int i = 0; i < 50; ++i) informationOf();
  EXPECT_GT(own.value(), 0.7);
  EXPECT_GT(informationOf(), 1.3 * before);
}

TEST_F(Refinement, ACorridorIsFixedAcrossAndHardlyAlong) {
  map(test::corridor(), 0.01);
  const PlanarScan scan = seenFrom(test::corridor(), {}, random, 0.01);
  GridRefinement start = onGrid(scan, {0, 0.01, 0});
  const auto fit = refineOnSurfaces(surfaces, faced(scan), start, {});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->map_from_scan.y, 0, 0.005);
  EXPECT_GT(fit->information(1, 1), 20 * fit->information(0, 0));
  // The prior's weight against the weakest direction: it holds the place along the corridor, not across.
  const PosePrior prior{{0.05, 0.05, 0}, 1000, 0, Eigen::Matrix2d::Zero()};
  const auto held = refineOnSurfaces(surfaces, faced(scan), start, prior);
  ASSERT_TRUE(held);
  EXPECT_NEAR(held->map_from_scan.x, 0.05, 0.005);
  EXPECT_NEAR(held->map_from_scan.y, 0, 0.01);
}

// Wheels that say something else than a room that shows every direction have slipped; a corridor does not contradict what they say along it.
TEST_F(Refinement, APredictionThatTheScanContradictsHardlyCounts) {
  const PosePrior slipped{.pose = {0.1, 0, 0}, .information_per_m2 = 1e5 * Eigen::Matrix2d::Identity(), .may_slip = true};
  PosePrior certain = slipped;
  certain.may_slip = false;
  map(test::asymmetricRoom(), 0.01);
  const PlanarScan room = seenFrom(test::asymmetricRoom(), {}, random, 0.01);
  const auto in_room = refineOnSurfaces(surfaces, faced(room), onGrid(room, {}), slipped);
  const auto held = refineOnSurfaces(surfaces, faced(room), onGrid(room, {}), certain);
  ASSERT_TRUE(in_room && held);
  EXPECT_LT(in_room->trust, 0.01);
  EXPECT_EQ(held->trust, 1);
  EXPECT_NEAR(in_room->map_from_scan.x, 0, 0.004);
  EXPECT_GT(held->map_from_scan.x, 0.01);
  surfaces = LocalSurfaces(0.05);
  map(test::corridor(), 0.01);
  const PlanarScan corridor = seenFrom(test::corridor(), {}, random, 0.01);
  const auto along = refineOnSurfaces(surfaces, faced(corridor), onGrid(corridor, {}), slipped);
  ASSERT_TRUE(along);
  EXPECT_GT(along->trust, 0.9);
  EXPECT_NEAR(along->map_from_scan.x, 0.1, 0.005);
}

TEST_F(Refinement, NothingInAPlaceThatTheMapDoesNotShow) {
  map(test::asymmetricRoom(), 0.01);
  const PlanarScan elsewhere = seenFrom(test::boxAt(-1, -1, 2, 2), {}, random, 0.01);
  GridRefinement grid_only;
  grid_only.grid_from_scan = {0, 0.5, 0};
  EXPECT_FALSE(refineOnSurfaces(surfaces, faced(elsewhere), grid_only, {}));
  const Pose2 before = grid_only.grid_from_scan;
  OwnShare own;
  refineFurther(surfaces, faced(elsewhere), {}, own, grid_only);
  EXPECT_FALSE(grid_only.on_surfaces);
  EXPECT_EQ(grid_only.grid_from_scan.y, before.y);
}

// Two rooms with a wall of 10 cm between them, one of which is in the map.
TEST_F(Refinement, TheWallOfTheNextRoomIsSeenFromBehindByAScanOutOfItsPlace) {
  const auto room = test::boxAt(-4, -2, 3.95, 4), next = test::boxAt(0.05, -2, 4, 4);
  for (int i = 0; i < 20; ++i) insert({-2 + 0.03 * i, 0.02 * i, 0.05 * i}, room, 0.005);
  const Pose2 in_room{-1.5, 0.2, 0.3}, in_next{1.5, 0.2, 0.3};
  EXPECT_LT(shareOnWrongSide(surfaces, faced(seenFrom(room, in_room, random, 0.005)), in_room), 0.02);
  const FacedScan scan = faced(seenFrom(next, in_next, random, 0.005));
  EXPECT_LT(shareOnWrongSide(surfaces, scan, in_next), 0.02) << "a wall thicker than the errors";
  EXPECT_GT(shareOnWrongSide(surfaces, scan, {in_next.x - 0.1, in_next.y, in_next.yaw}), 0.8);
  EXPECT_EQ(shareOnWrongSide(surfaces, scan, {in_next.x + 50, in_next.y, in_next.yaw}), 0) << "nothing known there";
}

}  // namespace
}  // namespace roomgraph
