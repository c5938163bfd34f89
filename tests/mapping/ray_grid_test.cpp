// SPDX-License-Identifier: BSD-3-Clause
// Cells of a grid after single beams, by hand, and which scans and depth images the mapper takes.
#include "ray_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/mapping/occupancy_mapper.h"

namespace roomgraph {
namespace {

constexpr double kHit = 0.7, kPass = 0.45;

// A row of ten cells of 0.1 m.
class RowOfCells : public ::testing::Test {
 protected:
  RowOfCells() {
    grid.setSize(0, 1, 0, 0.1F, 0.1F);
    grid.fill(0.5F);
  }
  double occupied(int cell) const { return 1 - static_cast<double>(grid.getCell(cell, 0)); }
  static Ray to(double x, bool hit) { return {{x, 0.05}, hit}; }
  mrpt::maps::COccupancyGridMap2D grid;
  const Eigen::Vector2d origin{0.05, 0.05};
};

double twice(double probability) {
  const double odds = std::pow(probability / (1 - probability), 2);
  return odds / (1 + odds);
}

TEST_F(RowOfCells, OneScanChangesACellOnceAndAReturnOutweighsWhatPasses) {
  RayGrid rays(grid, kHit, kPass);
  rays.insert(origin, {to(0.72, true), to(0.78, true), to(0.95, false)});
  for (const int cell : {1, 3, 6}) EXPECT_NEAR(occupied(cell), kPass, 0.01) << "three beams passed " << cell;
  EXPECT_NEAR(occupied(7), kHit, 0.01) << "two returns, and a beam that passes";
  EXPECT_NEAR(occupied(8), kPass, 0.01);
  EXPECT_NEAR(occupied(9), kPass, 0.01) << "free up to the beam's end, its last cell too";
  rays.insert(origin, {to(0.75, true)});
  EXPECT_NEAR(occupied(7), twice(kHit), 0.01);
  EXPECT_NEAR(occupied(3), twice(kPass), 0.01);
  EXPECT_NEAR(occupied(9), kPass, 0.01);
}

// Of the probabilities that may be set the ones nearest to a half: a cell has 255 steps.
TEST_F(RowOfCells, LittleEvidenceIsNotNone) {
  RayGrid rays(grid, 0.501, 0.499);
  rays.insert(origin, {to(0.55, true)});
  EXPECT_GT(occupied(5), 0.5);
  EXPECT_LT(occupied(3), 0.5);
  EXPECT_NEAR(occupied(5), 0.5, 0.02);
}

TEST_F(RowOfCells, BehindAReturnNothingIsKnown) {
  RayGrid rays(grid, kHit, kPass);
  rays.insert(origin, {to(0.55, true)});
  EXPECT_NEAR(occupied(5), kHit, 0.01);
  EXPECT_NEAR(occupied(6), 0.5, 1e-6);
  EXPECT_NEAR(occupied(9), 0.5, 1e-6);
}

Scan oneBeam(double t, double range_m) {
  Scan scan;
  scan.t = t;
  scan.max_range_m = 20;
  scan.ranges_m = {static_cast<float>(range_m)};
  scan.valid = {1};
  return scan;
}

// Within 3 cm: the place may lie on the border of two cells.
bool isWall(const mrpt::maps::COccupancyGridMap2D& grid, double x, double y) {
  for (const double dx : {-0.03, 0.0, 0.03})
    for (const double dy : {-0.03, 0.0, 0.03})
      if (grid.getPos(static_cast<float>(x + dx), static_cast<float>(y + dy)) < 0.4F) return true;
  return false;
}

// Within two seconds a robot that neither moves nor turns says nothing new.
TEST(OccupancyMapper, AStandingRobotsScansCountNowAndThen) {
  OccupancyMapper mapper;
  mapper.add(oneBeam(0, 2.025));
  mapper.add(oneBeam(1.9, 2.525));
  mapper.add(oneBeam(2.1, 3.025));
  Trajectory standing;
  standing.add(0, Pose3::Identity());
  standing.add(3, Pose3::Identity());
  const auto grid = mapper.build(standing);
  ASSERT_TRUE(grid);
  EXPECT_TRUE(isWall(*grid, 3.025, 0));
  EXPECT_FALSE(isWall(*grid, 2.525, 0));
}

TEST(OccupancyMapper, TurningIsReasonEnoughForAScan) {
  OccupancyMapper mapper;
  mapper.add(oneBeam(0, 2));
  mapper.add(oneBeam(0.5, 2));
  Trajectory turning;
  turning.add(0, Pose3::Identity());
  turning.add(0.5, poseFromYpr(0, 0, 0, 1, 0, 0));
  const auto grid = mapper.build(turning);
  ASSERT_TRUE(grid);
  EXPECT_TRUE(isWall(*grid, 2, 0));
  EXPECT_TRUE(isWall(*grid, 2 * std::cos(1.0), 2 * std::sin(1.0)));
}

// A wall 3 m ahead of a level camera 1 m above the floor.
Frame wallAhead() {
  Frame frame;
  frame.camera = {160, 120, 130, 130, 79.5, 59.5, {}};
  frame.robot_from_camera = poseFromYpr(0, 0, 1, 0, 0, 0);
  frame.robot_from_camera.linear() = bodyFromOptical();
  frame.depth = cv::Mat(120, 160, CV_32FC1, cv::Scalar(3.02));
  return frame;
}

TEST(OccupancyMapper, DepthFillsTheGridOnlyWhereItIsAskedTo) {
  Trajectory standing;
  standing.add(0, Pose3::Identity());
  for (const auto& [source, with_scans, drawn] :
       {std::tuple{"auto", true, false}, {"auto", false, true}, {"both", true, true}, {"depth", true, true}}) {
    OccupancyOptions options;
    options.source = source;
    OccupancyMapper mapper(options);
    if (with_scans) mapper.add(oneBeam(0, 4));
    const Frame frame = wallAhead();
    mapper.add(frame, groundInCamera(frame.robot_from_camera));
    const auto grid = mapper.build(standing);
    ASSERT_TRUE(grid);
    EXPECT_EQ(isWall(*grid, 3.02, 0.5), drawn) << source << (with_scans ? " with scans" : "");
  }
}

// A lamp hangs 1.4 m in front of the wall; in the image it covers the rows that look up steeply.
TEST(FanFromDepth, WhatHangsHigherThanTheBandIsNoObstacle) {
  Frame frame = wallAhead();
  const Plane ground = groundInCamera(frame.robot_from_camera);
  frame.depth(cv::Rect(60, 0, 40, 20)) = 1.6F;  // 1.49 m above the floor, at least
  DepthSlice slice;
  slice.step_px = 1;
  const auto nearest = [&] {
    float out = 100;
    for (const float range : fanFromDepth(frame, ground, slice).ranges_m)
      if (range > 0) out = std::min(out, range);
    return out;
  };
  EXPECT_NEAR(nearest(), 1.6F, 0.05) << "within the usual band of 1.6 m";
  slice.max_height_m = 1.45;
  EXPECT_NEAR(nearest(), 3.02F, 0.05);
}

}  // namespace
}  // namespace roomgraph
