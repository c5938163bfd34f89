// SPDX-License-Identifier: BSD-3-Clause
// Outlines of random cells against the cells themselves.
#include "roomgraph/maptools/grid_outlines.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph {
namespace {

double signedArea(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    twice += polygon[j].x() * polygon[i].y() - polygon[i].x() * polygon[j].y();
  return twice / 2;
}

TEST(GridOutlines, OneCellIsASquareAroundItsCentre) {
  mrpt::maps::COccupancyGridMap2D grid(-1.f, 1.f, 2.f, 3.5f, 0.5f);
  grid.fill(1.f);
  grid.setCell(1, 2, 0.f);
  const auto outlines = outlinesOf(grid, isOccupiedCell);
  ASSERT_EQ(outlines.size(), 1u);
  ASSERT_EQ(outlines[0].size(), 4u);
  EXPECT_DOUBLE_EQ(signedArea(outlines[0]), 0.25);
  EXPECT_EQ(boundsOf(outlines[0]).min(), Eigen::Vector2d(-0.5, 3));
  EXPECT_EQ(boundsOf(outlines[0]).max(), Eigen::Vector2d(0, 3.5));
}

// Areas add up, and every cell is inside exactly when it was chosen (even-odd), holes and touching corners
// included.
TEST(GridOutlines, RandomCellsComeBack) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    mrpt::maps::COccupancyGridMap2D grid(0.f, 0.6f, 0.f, 0.45f, 0.05f);
    grid.fill(1.f);
    int chosen = 0;
    const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (random() % 2) grid.setCell(x, y, 0.f), ++chosen;
    const auto outlines = outlinesOf(grid, isOccupiedCell);
    double area = 0;
    for (const auto& outline : outlines) area += signedArea(outline);
    EXPECT_NEAR(area, chosen * 0.0025, 1e-7);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        int around = 0;
        for (const auto& outline : outlines) around += contains(outline, cellCentre(grid, x, y));
        EXPECT_EQ(around % 2 == 1, isOccupiedCell(grid.getCell(x, y))) << x << " " << y;
      }
  }
}

TEST(GridOutlines, ThinWallsOfFineGridsStay) {
  for (const float cell : {0.05f, 0.03f, 0.02f, 0.01f}) {
    mrpt::maps::COccupancyGridMap2D grid(0, 50 * cell, 0, 50 * cell, cell);
    grid.fill(0.99f);
    for (int y = 10; y < 40; ++y) grid.setCell(20, y, 0.01f);  // a wall of one cell
    const auto walls = simplified(outlinesOf(grid, isOccupiedCell), outlineTolerance(grid));
    ASSERT_EQ(walls.size(), 1u) << cell;
    double twice = 0;
    for (std::size_t i = 0, j = walls[0].size() - 1; i < walls[0].size(); j = i++)
      twice += walls[0][j].x() * walls[0][i].y() - walls[0][i].x() * walls[0][j].y();
    EXPECT_NEAR(twice / 2, 30.0 * static_cast<double>(cell * cell), 0.05 * 30 * static_cast<double>(cell * cell)) << cell;
  }
}

TEST(GridOutlines, SimplifiedStaysNear) {
  const std::vector<Polygon2> steps{{{0, 0}, {2, 0}, {2, 0.02}, {4, 0.02}, {4, 2}, {0, 2}}};
  const auto simple = simplified(steps, 0.03);
  ASSERT_EQ(simple.size(), 1u);
  EXPECT_EQ(simple[0].size(), 4u);
  for (const auto& corner : steps[0]) EXPECT_LT(std::abs(distanceTo(simple[0], corner)), 0.03);
  const std::vector<Polygon2> pole{{{0, 0}, {0.02, 0}, {0.02, 0.02}, {0, 0.02}}};
  EXPECT_EQ(simplified(pole, 0.03), pole) << "what is thinner than the tolerance stays";
}

}  // namespace
}  // namespace roomgraph
