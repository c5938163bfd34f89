// SPDX-License-Identifier: BSD-3-Clause
// Scan conversion: beam directions against MRPT's point map, dropouts, round trip.
#include "roomgraph/observations/scan.h"

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <limits>
#include <numbers>

namespace roomgraph {
namespace {

mrpt::obs::CObservation2DRangeScan observation(bool right_to_left) {
  mrpt::obs::CObservation2DRangeScan out;
  out.timestamp = mrpt::Clock::fromDouble(1700000000.25);
  out.sensorLabel = "LIDAR";
  out.aperture = static_cast<float>(std::numbers::pi);
  out.maxRange = 10;
  out.rightToLeft = right_to_left;
  out.sensorPose = mrpt::poses::CPose3D(0.2, -0.1, 0.3, 0.4, 0, 0);
  const float ranges[] = {1, 2, 3, 4, 5};
  out.resizeScan(5);
  for (std::size_t i = 0; i < 5; ++i) {
    out.setScanRange(i, ranges[i]);
    out.setScanRangeValidity(i, true);
  }
  return out;
}

TEST(Scan, BeamsPointWhereTheyShould) {
  // Five beams over 180 deg: the first one points right (right to left) or left (left to right).
  for (const bool right_to_left : {true, false}) {
    auto mrpt_scan = observation(right_to_left);
    mrpt_scan.sensorPose = mrpt::poses::CPose3D();
    const auto points = toScan(mrpt_scan).pointsInRobot();
    ASSERT_EQ(points.size(), 5u);
    const double side = right_to_left ? -1 : 1;
    EXPECT_LT((points[0] - Eigen::Vector3d(0, side, 0)).norm(), 1e-6);
    EXPECT_LT((points[2] - Eigen::Vector3d(3, 0, 0)).norm(), 1e-6);
    EXPECT_LT((points[4] - Eigen::Vector3d(0, -5 * side, 0)).norm(), 1e-6);
  }
}

TEST(Scan, PointsAgreeWithMrptsOwnPointMap) {
  for (const bool right_to_left : {true, false}) {
    const auto mrpt_scan = observation(right_to_left);
    mrpt::maps::CSimplePointsMap map;
    map.insertionOptions.minDistBetweenLaserPoints = 0;
    map.loadFromRangeScan(mrpt_scan);
    const auto points = toScan(mrpt_scan).pointsInRobot();
    ASSERT_EQ(map.size(), points.size());
    for (const auto& p : points) {
      double nearest = 1e9;
      for (std::size_t i = 0; i < map.size(); ++i) {
        float x = 0, y = 0, z = 0;
        map.getPoint(i, x, y, z);
        nearest = std::min(nearest, (p - Eigen::Vector3d(x, y, z)).norm());
      }
      EXPECT_LT(nearest, 1e-4);
    }
  }
}

TEST(Scan, DropoutsAndOutOfRangeAreInvalid) {
  auto mrpt_scan = observation(true);
  mrpt_scan.setScanRangeValidity(0, false);
  mrpt_scan.setScanRange(1, 0);
  mrpt_scan.setScanRange(2, std::numeric_limits<float>::quiet_NaN());
  mrpt_scan.setScanRange(3, 10);  // the largest range stands for "nothing"
  const auto scan = toScan(mrpt_scan);
  EXPECT_EQ(scan.valid, (std::vector<char>{0, 0, 0, 0, 1}));
  EXPECT_EQ(scan.pointsInRobot().size(), 1u);
  for (const float range : scan.ranges_m) EXPECT_TRUE(std::isfinite(range));
}

TEST(Scan, RoundTripsThroughMrpt) {
  for (const bool right_to_left : {true, false}) {
    auto original = observation(right_to_left);
    original.setScanRangeValidity(3, false);
    const Scan scan = toScan(original), again = toScan(*toMrpt(scan));
    EXPECT_EQ(toMrpt(scan)->rightToLeft, right_to_left);
    EXPECT_NEAR(again.t, 1700000000.25, 1e-6);
    EXPECT_EQ(again.sensor_label, "LIDAR");
    EXPECT_EQ(again.ranges_m, scan.ranges_m);
    EXPECT_EQ(again.valid, scan.valid);
    EXPECT_NEAR(again.angle_min_rad, scan.angle_min_rad, 1e-6);
    EXPECT_NEAR(again.angle_step_rad, scan.angle_step_rad, 1e-6);
    EXPECT_EQ(again.max_range_m, 10);
    EXPECT_TRUE(again.robot_from_lidar.isApprox(scan.robot_from_lidar, 1e-9));
  }
}

TEST(Scan, EmptyScan) {
  const Scan scan = toScan(mrpt::obs::CObservation2DRangeScan());
  EXPECT_TRUE(scan.pointsInRobot().empty());
  EXPECT_EQ(toMrpt(scan)->getScanSize(), 0u);
}

}  // namespace
}  // namespace roomgraph
