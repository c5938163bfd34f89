// SPDX-License-Identifier: BSD-3-Clause
// Range fans from rendered depth images and from scans.
#include "roomgraph/mapping/range_fan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

/// Camera 0.9 m above the floor of a room whose only wall is the plane x = 3 (up to `wall_height`), pitched
/// down and rolled; the depth image follows from intersecting each pixel's ray with wall and floor.
Frame frameOfWall(double pitch, double roll, double wall_height) {
  Frame frame;
  frame.camera = {160, 120, 130, 130, 79.5, 59.5, {}};
  frame.robot_from_camera = poseFromYpr(0.1, 0, 0.9, 0, pitch, roll);
  frame.robot_from_camera.linear() *= bodyFromOptical();
  frame.depth = cv::Mat::zeros(120, 160, CV_32FC1);
  const Eigen::Vector3d eye = frame.robot_from_camera.translation();
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Eigen::Vector3d ray = frame.robot_from_camera.linear() * frame.camera.ray(u, v);
      double depth = 0;  // rays have z = 1 in the camera: the ray parameter is the depth
      if (ray.z() < 0) depth = -eye.z() / ray.z();
      const double wall = (3 - eye.x()) / ray.x();
      if (wall > 0 && (depth == 0 || wall < depth) && eye.z() + wall * ray.z() < wall_height) depth = wall;
      frame.depth.at<float>(v, u) = static_cast<float>(depth);
    }
  }
  return frame;
}

TEST(FanFromDepth, LevelWhenTheCameraIsNot) {
  for (const auto& [pitch, roll] : {std::pair{0.0, 0.0}, {0.3, 0.0}, {0.2, 0.15}, {-0.1, -0.2}}) {
    const Frame frame = frameOfWall(pitch, roll, 2.5);
    DepthSlice slice;
    slice.step_px = 1;
    const RangeFan fan = fanFromDepth(frame, groundInCamera(frame.robot_from_camera), slice);
    ASSERT_GT(fan.ranges_m.size(), 80u);
    EXPECT_NEAR(fan.robot_from_fan.translation().z(), 0, 1e-9);
    EXPECT_NEAR(fan.robot_from_fan.linear()(2, 2), 1, 1e-9);
    int returns = 0;
    for (std::size_t i = 0; i < fan.ranges_m.size(); ++i) {
      if (fan.ranges_m[i] <= 0) continue;
      const double angle = fan.angle_min_rad + static_cast<double>(i) * fan.angle_step_rad;
      const double range = static_cast<double>(fan.ranges_m[i]);
      const Eigen::Vector3d p =
          fan.robot_from_fan * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0);
      EXPECT_NEAR(p.x(), 3, 0.02) << "pitch " << pitch << " roll " << roll << " beam " << i;
      ++returns;
    }
    EXPECT_GT(returns, 70);
  }
}

// A person 1.5 m ahead, in the middle of the image; the box covers them and some wall.
TEST(FanFromDepth, PeopleAreNeitherDrawnNorSeenThrough) {
  Frame frame = frameOfWall(0, 0, 2.5);
  const Box2 person{60, 30, 100, 120};
  frame.depth(cv::Rect(65, 35, 30, 85)).setTo(1.5F);
  const Plane ground = groundInCamera(frame.robot_from_camera);
  DepthSlice slice;
  slice.step_px = 1;
  const auto nearer = [&](const RangeFan& fan) {
    return std::count_if(fan.ranges_m.begin(), fan.ranges_m.end(), [](float r) { return r > 0 && r < 2; });
  };
  EXPECT_GT(nearer(fanFromDepth(frame, ground, slice)), 20);
  const RangeFan without = fanFromDepth(frame, ground, slice, {person});
  EXPECT_EQ(nearer(without), 0);
  int unknown = 0, walls = 0;
  for (std::size_t i = 0; i < without.ranges_m.size(); ++i) {
    const double u =
        frame.camera
            .project(
                {-std::tan(without.angle_min_rad + static_cast<double>(i) * without.angle_step_rad), 0, 1})
            .x();
    if (u > person.u_min + 1 && u < person.u_max - 1) {
      EXPECT_EQ(without.ranges_m[i], 0) << "nothing is known behind a person, column " << u;
      ++unknown;
    } else if (u < person.u_min - 1 || u > person.u_max + 1) {
      walls += without.ranges_m[i] > 2;
    }
  }
  EXPECT_GT(unknown, 20);
  EXPECT_GT(walls, 40);
}

TEST(FanFromDepth, FloorAloneIsFree) {
  const Frame frame = frameOfWall(0.3, 0, 0.0);  // no wall: floor everywhere below the horizon
  DepthSlice slice;
  slice.max_range_m = 2;
  slice.step_px = 1;
  const RangeFan fan = fanFromDepth(frame, groundInCamera(frame.robot_from_camera), slice);
  ASSERT_GT(fan.ranges_m.size(), 50u);
  for (float range : fan.ranges_m) {
    EXPECT_LE(range, 0.f);
    EXPECT_GE(range, -2.f);
  }
  EXPECT_NEAR(fan.ranges_m[fan.ranges_m.size() / 2], -2.f, 0.1f);
}

TEST(FanFromDepth, LonePixelsAreNoObstacle) {
  Frame frame = frameOfWall(0.3, 0, 2.5);
  const Plane ground = groundInCamera(frame.robot_from_camera);
  DepthSlice slice;
  slice.step_px = 1;
  const RangeFan clean = fanFromDepth(frame, ground, slice);
  frame.depth.at<float>(40, 80) = 0.7f;
  EXPECT_EQ(fanFromDepth(frame, ground, slice).ranges_m.size(), clean.ranges_m.size());
  for (float range : fanFromDepth(frame, ground, slice).ranges_m) EXPECT_FALSE(range > 0 && range < 2);
}

TEST(FanFromDepth, NothingSeenIsNothingKnown) {
  Frame frame = frameOfWall(0.3, 0, 2.5);
  frame.depth = 0;
  EXPECT_TRUE(fanFromDepth(frame, groundInCamera(frame.robot_from_camera), {}).ranges_m.empty());
}

TEST(FanFromScan, ReturnsDropoutsAndEmptyDirections) {
  Scan scan;
  scan.max_range_m = 10;
  scan.angle_min_rad = -1;
  scan.angle_step_rad = 0.1;
  scan.ranges_m = {2, 10, 3, 10, 10, 10, 4, 0};
  scan.valid = {1, 0, 1, 0, 0, 0, 1, 0};
  EXPECT_EQ(fanFromScan(scan, 4).ranges_m, (std::vector<float>{2, 0, 3, 0, -4, 0, 4, 0}));
  EXPECT_EQ(fanFromScan(scan, 20).ranges_m[4], -10.f);
  EXPECT_EQ(fanFromScan(scan, 0).ranges_m[4], 0.f);
}

}  // namespace
}  // namespace roomgraph
