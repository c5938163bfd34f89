// SPDX-License-Identifier: BSD-3-Clause
// OccupancyMapper against the walls of a ray-cast room.
#include "roomgraph/mapping/occupancy_mapper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr double kWest = -2.5, kEast = 3.5, kSouth = -1.5, kNorth = 2.5;  // walls of the room
constexpr double kBox = 0.5;  // a square obstacle [1.5, 2] x [1, 1.5]

/// Distance along a ray to the room's walls or the obstacle, by intersecting with each line.
double castRay(const Eigen::Vector2d& eye, double angle) {
  const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
  double best = std::min(d.x() > 0 ? (kEast - eye.x()) / d.x() : (kWest - eye.x()) / d.x(),
                         d.y() > 0 ? (kNorth - eye.y()) / d.y() : (kSouth - eye.y()) / d.y());
  for (const double x : {1.5, 1.5 + kBox}) {
    const double s = (x - eye.x()) / d.x(), y = eye.y() + s * d.y();
    if (s > 0 && y >= 1 && y <= 1 + kBox) best = std::min(best, s);
  }
  for (const double y : {1.0, 1.0 + kBox}) {
    const double s = (y - eye.y()) / d.y(), x = eye.x() + s * d.x();
    if (s > 0 && x >= 1.5 && x <= 1.5 + kBox) best = std::min(best, s);
  }
  return best;
}

Pose3 robotAt(double t) {
  return toPose3(Pose2{-1.5 + 0.4 * t, -0.5 + 0.1 * t, 0.3 * t});
}

Scan scanAt(double t, const Pose3& world_from_robot) {
  Scan scan;
  scan.t = t;
  scan.max_range_m = 20;
  scan.robot_from_lidar = poseFromYpr(0.2, 0.1, 0.3, 0.5, 0, 0);
  scan.angle_min_rad = -M_PI;
  scan.angle_step_rad = M_PI / 360;
  const Pose2 world_from_lidar = planarPart(world_from_robot * scan.robot_from_lidar);
  for (int i = 0; i < 720; ++i) {
    const double angle = scan.angle_min_rad + i * scan.angle_step_rad + world_from_lidar.yaw;
    scan.ranges_m.push_back(static_cast<float>(castRay({world_from_lidar.x, world_from_lidar.y}, angle)));
    scan.valid.push_back(1);
  }
  return scan;
}

/// How many of the test's scans have a free line of sight to well beyond p.
int scansThatSee(const Eigen::Vector2d& p) {
  int count = 0;
  for (int i = 0; i <= 40; ++i) {
    const Eigen::Vector2d eye = (robotAt(0.25 * i) * Eigen::Vector3d(0.2, 0.1, 0.3)).head<2>();
    const Eigen::Vector2d way = p - eye;
    count += castRay(eye, std::atan2(way.y(), way.x())) > way.norm() + 0.1;
  }
  return count;
}

Trajectory roomTrajectory() {
  Trajectory trajectory;
  for (int i = 0; i <= 100; ++i) trajectory.add(0.1 * i, robotAt(0.1 * i));
  return trajectory;
}

TEST(OccupancyMapper, RoomHasWallsWhereTheyAre) {
  OccupancyMapper mapper;
  for (int i = 0; i <= 40; ++i) mapper.add(scanAt(0.25 * i, robotAt(0.25 * i)));
  const auto grid = mapper.build(roomTrajectory());
  ASSERT_TRUE(grid);
  int occupied = 0;
  for (unsigned y = 0; y < grid->getSizeY(); ++y) {
    for (unsigned x = 0; x < grid->getSizeX(); ++x) {
      const Eigen::Vector2d p(static_cast<double>(grid->idx2x(x)), static_cast<double>(grid->idx2y(y)));
      const float p_free = grid->getCell(static_cast<int>(x), static_cast<int>(y));
      const double to_wall = std::min({std::abs(p.x() - kWest), std::abs(p.x() - kEast),
                                       std::abs(p.y() - kSouth), std::abs(p.y() - kNorth)});
      const double to_box = std::max(std::abs(p.x() - 1.75), std::abs(p.y() - 1.25)) - kBox / 2;
      const bool inside = p.x() > kWest && p.x() < kEast && p.y() > kSouth && p.y() < kNorth;
      if (p_free < 0.3f) {
        ++occupied;
        EXPECT_TRUE(to_wall < 0.08 || std::abs(to_box) < 0.08) << "obstacle at " << p.transpose();
      }
      if (inside && to_wall > 0.1 && to_box > 0.1 && scansThatSee(p) > 8) {
        EXPECT_GT(p_free, 0.7f) << "not free: " << p.transpose();
      }
      if (to_box < -0.08) {
        EXPECT_NEAR(p_free, 0.5f, 0.05) << "inside of the obstacle known at " << p.transpose();
      }
      if (!inside && to_wall > 0.08) {
        EXPECT_NEAR(p_free, 0.5f, 0.05) << "behind the wall: " << p.transpose();
      }
    }
  }
  // 20 m of wall and 2 m of obstacle in cells of 0.05 m.
  EXPECT_GT(occupied, 380);
  EXPECT_NEAR(grid->getXMax() - grid->getXMin(), 6 + 1, 0.15) << "the grid does not fit what was seen";
}

TEST(OccupancyMapper, MovesWithTheTrajectory) {
  OccupancyMapper mapper;
  for (int i = 0; i <= 10; ++i) mapper.add(scanAt(i, robotAt(i)));
  const auto before = mapper.build(roomTrajectory());
  Trajectory shifted;
  const Pose3 shift = toPose3(Pose2{10, -4, 0});
  const Trajectory original = roomTrajectory();
  for (const auto& stamped : original.poses()) shifted.add(stamped.t, shift * stamped.pose);
  const auto after = mapper.build(shifted);
  for (double x = kWest; x < kEast; x += 0.31) {
    const auto fx = static_cast<float>(x);
    EXPECT_EQ(before->getPos(fx, 0.03f) > 0.6f, after->getPos(fx + 10, -3.97f) > 0.6f) << x;
  }
  EXPECT_LT(after->getPos(static_cast<float>(kEast + 10.01), -3.97f), 0.4f);
}

// Log odds are sums: two sessions one after the other are one session, cell by cell.
TEST(OccupancyMapper, AnEarlierGridIsContinuedExactly) {
  OccupancyMapper first, second, all;
  Trajectory way;  // no wall on the border of two cells, where rounding decides
  for (int i = 0; i <= 10; ++i) way.add(i, toPose3(Pose2{0.013, 0.017, 0}) * robotAt(i));
  for (int i = 0; i < 8; ++i)
    for (OccupancyMapper* mapper : {i < 4 ? &first : &second, &all}) mapper->add(scanAt(i, robotAt(i)));
  const auto earlier = first.build(way);
  const auto both = second.build(way, earlier.get());
  const auto once = all.build(way);
  int known = 0;
  for (unsigned y = 0; y < once->getSizeY(); ++y)
    for (unsigned x = 0; x < once->getSizeX(); ++x) {
      const float at_x = once->idx2x(x), at_y = once->idx2y(y);
      EXPECT_EQ(once->getPos(at_x, at_y), both->getPos(at_x, at_y)) << at_x << ' ' << at_y;
      known += std::abs(once->getPos(at_x, at_y) - earlier->getPos(at_x, at_y)) > 0.05f;
    }
  EXPECT_GT(known, 1000) << "the second session tells more";
  const OccupancyMapper nothing;
  EXPECT_EQ(nothing.build({}, earlier.get())->getRawMap(), earlier->getRawMap());
}

TEST(OccupancyMapper, AnEarlierGridGrowsOnItsLattice) {
  OccupancyMapper mapper;
  mapper.add(scanAt(0, robotAt(0)));
  auto small = mrpt::maps::COccupancyGridMap2D::Create(-0.3f, 0.3f, -0.3f, 0.3f, 0.1f);
  small->fill(0.5f);
  small->setPos(0.25f, -0.15f, 0.1f);
  Trajectory elsewhere;
  elsewhere.add(0, toPose3(Pose2{20, 20, 0}));
  const auto grown = mapper.build(elsewhere, small.get());
  EXPECT_FLOAT_EQ(grown->getResolution(), 0.1f);
  EXPECT_EQ(grown->getPos(0.25f, -0.15f), small->getPos(0.25f, -0.15f));
  EXPECT_FLOAT_EQ(grown->getXMin(), small->getXMin());
  EXPECT_GT(grown->getXMax(), 20);
}

// Depth shows the grid where the lidar has stopped, and where it has not begun; beside scans they are not drawn.
TEST(OccupancyMapper, DepthGoesOnWhereTheLidarStops) {
  OccupancyMapper mapper;
  Trajectory path;
  for (int i = 0; i <= 60; ++i) path.add(i, toPose3(Pose2{4.0 * i, 0, 0}));
  for (int i = 20; i <= 30; ++i) mapper.add(scanAt(i, robotAt(0)));
  for (int i = 0; i <= 60; ++i) {
    RangeFan slice;
    slice.t = i;
    slice.angle_min_rad = -0.05;
    slice.angle_step_rad = 0.01;
    slice.ranges_m.assign(11, 1.5f);
    mapper.add(std::move(slice));
  }
  const auto grid = mapper.build(path);
  ASSERT_TRUE(grid);
  const auto free = [&](int i) { return grid->getPos(static_cast<float>(4 * i + 1), 0.f) > 0.5f; };
  for (const int i : {0, 10, 40, 60}) EXPECT_TRUE(free(i)) << i;
  EXPECT_TRUE(mapper.drawsDepth(10) && mapper.drawsDepth(40));
  EXPECT_FALSE(mapper.drawsDepth(17) || mapper.drawsDepth(25) || mapper.drawsDepth(33));
}

TEST(OccupancyMapper, WithoutScansOrPosesThereIsNoGrid) {
  OccupancyMapper mapper;
  EXPECT_FALSE(mapper.build(roomTrajectory()));
  mapper.add(scanAt(500, robotAt(0)));
  EXPECT_FALSE(mapper.build(roomTrajectory())) << "the scan lies outside the trajectory";
  EXPECT_FALSE(mapper.build({}));
}

TEST(OccupancyMapper, AbsurdExtentIsARunError) {
  OccupancyMapper mapper;
  mapper.add(scanAt(0, robotAt(0)));
  mapper.add(scanAt(1, robotAt(1)));
  Trajectory trajectory;
  trajectory.add(0, Pose3::Identity());
  trajectory.add(1, toPose3(Pose2{1e7, 1e7, 0}));
  EXPECT_THROW(mapper.build(trajectory), RunError);
}

TEST(OccupancyMapper, ReturnsBeyondTheRangeOnlyFree) {
  OccupancyOptions options;
  options.max_range_m = 1.3;
  OccupancyMapper mapper(options);
  mapper.add(scanAt(0, robotAt(0)));
  const auto grid = mapper.build(roomTrajectory());
  const Eigen::Vector3d lidar = robotAt(0) * Eigen::Vector3d(0.2, 0.1, 0);
  EXPECT_GT(grid->getPos(static_cast<float>(lidar.x() + 0.9), static_cast<float>(lidar.y())), 0.5f);
  EXPECT_LT(grid->getXMax(), lidar.x() + 2);
  int occupied = 0;
  for (const auto cell : grid->getRawMap()) occupied += cell < 0;
  for (unsigned y = 0; y < grid->getSizeY(); ++y)
    for (unsigned x = 0; x < grid->getSizeX(); ++x)
      if (grid->getCell(static_cast<int>(x), static_cast<int>(y)) < 0.4f) {
        EXPECT_LT(std::hypot(grid->idx2x(x) - lidar.x(), grid->idx2y(y) - lidar.y()), 1.35);
        EXPECT_LT(std::min(std::abs(grid->idx2x(x) - kWest), std::abs(grid->idx2y(y) - kSouth)), 0.08)
            << "a wall where beams were cut";
      }
  EXPECT_GT(occupied, 0) << "the wall 1.1 m away must still be there";
}

}  // namespace
}  // namespace roomgraph
