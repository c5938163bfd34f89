// SPDX-License-Identifier: BSD-3-Clause
// Channels of an RGB-D picture and the levelling, against a room whose depth is a closed form.
#include "roomgraph/observations/rgbd_channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "roomgraph/geometry/degree.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {
namespace {

const PinholeCamera kCamera{320, 240, 260, 260, 159.5, 119.5, {}};

/// Depth of a room 5 m long and 4 m wide with a flat floor, without ceiling, seen from `height_m`; beyond 9
/// m: nothing.
cv::Mat roomDepth(const Eigen::Matrix3d& world_from_camera, double height_m) {
  const Eigen::Vector3d from(0, 0, height_m);
  cv::Mat depth = cv::Mat::zeros(kCamera.height, kCamera.width, CV_32F);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = world_from_camera * kCamera.ray(u, v);
      double z = std::numeric_limits<double>::infinity();
      const auto hit = [&](int axis, double at) {
        const double t = (at - from[axis]) / ray[axis];
        if (t > 0) z = std::min(z, t);
      };
      hit(2, 0);
      hit(0, 3.5);
      hit(0, -1.5);
      hit(1, 2);
      hit(1, -2);
      if (z < 9) depth.at<float>(v, u) = static_cast<float>(z);
    }
  }
  return depth;
}

Eigen::Matrix3d leaning(double pitch_deg, double roll_deg) {
  const Pose3 body = poseFromYpr(0, 0, 0, 0.3, pitch_deg * kDegree, roll_deg * kDegree);
  return body.linear() * bodyFromOptical();
}

struct Lean {
  double pitch_deg, roll_deg, height_m;
};

class LevellingTest : public ::testing::TestWithParam<Lean> {};

TEST_P(LevellingTest, FindsGravityAndFloor) {
  const auto [pitch, roll, height] = GetParam();
  const Eigen::Matrix3d world_from_camera = leaning(pitch, roll);
  const auto found = levelling(roomDepth(world_from_camera, height), kCamera);
  ASSERT_TRUE(found);
  const Eigen::Vector3d up = world_from_camera.transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(std::min(1.0, up.dot(found->up))) / kDegree, 0.5);
  EXPECT_NEAR(found->camera_height_m, height, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Views, LevellingTest,
                         ::testing::Values(Lean{10, 0, 0.4}, Lean{20, 5, 0.8}, Lean{35, -8, 1.6},
                                           Lean{15, 12, 1.2}));

TEST(RgbdChannelsTest, ValuesFollowTheirFormulas) {
  const Eigen::Matrix3d world_from_camera = leaning(25, 0);
  const cv::Mat depth = roomDepth(world_from_camera, 1.0),
                color(kCamera.height, kCamera.width, CV_8UC3, cv::Scalar(10, 20, 30));
  const auto channels = rgbdChannels(color, depth, kCamera, {kCamera.width, kCamera.height});
  ASSERT_EQ(channels.size(), static_cast<std::size_t>(kRgbdChannels));
  EXPECT_EQ(channels[kBlue].at<uchar>(50, 60), 10);
  EXPECT_EQ(channels[kGreen].at<uchar>(50, 60), 20);
  EXPECT_EQ(channels[kRed].at<uchar>(50, 60), 30);
  int floor = 0, wall = 0;
  for (int v = 8; v < depth.rows; v += 16) {
    for (int u = 8; u < depth.cols; u += 16) {
      const double z = depth.at<float>(v, u);
      const double height = 1.0 + (world_from_camera * kCamera.backProject(u, v, z)).z();
      EXPECT_NEAR(channels[kInverseDepth].at<uchar>(v, u), 255 * std::sqrt(0.4 / z), 1);
      EXPECT_NEAR(channels[kHeight].at<uchar>(v, u), 1 + 254 * std::min(1.0, (height + 0.2) / 2.6), 3);
      const int slope = channels[kSlope].at<uchar>(v, u);
      if (slope == 0) continue;  // at a corner of the room
      if (height < 0.01) {
        EXPECT_GE(slope, 252);
        ++floor;
      } else if (height > 0.1) {
        EXPECT_NEAR(slope, 128, 3);
        ++wall;
      }
    }
  }
  EXPECT_GT(floor, 40);
  EXPECT_GT(wall, 40);
}

TEST(RgbdChannelsTest, WhereNothingIsMeasuredAllDepthChannelsAreZero) {
  cv::Mat depth = roomDepth(leaning(20, 0), 1.0);
  depth(cv::Rect(100, 80, 60, 60)).setTo(0);
  const cv::Mat color(kCamera.height, kCamera.width, CV_8UC3, cv::Scalar::all(99));
  const auto channels = rgbdChannels(color, depth, kCamera, {kCamera.width, kCamera.height});
  for (const int channel : {kInverseDepth, kHeight, kSlope})
    EXPECT_EQ(cv::countNonZero(channels[static_cast<std::size_t>(channel)](cv::Rect(100, 80, 60, 60))), 0)
        << channel;
  EXPECT_EQ(cv::countNonZero(channels[kRed]), kCamera.width * kCamera.height);
}

TEST(RgbdChannelsTest, WithoutDepthThereIsColourAlone) {
  const cv::Mat color(480, 640, CV_8UC3, cv::Scalar(1, 2, 3));
  const auto channels = rgbdChannels(color, {}, kCamera, {256, 192});
  ASSERT_EQ(channels.size(), static_cast<std::size_t>(kRgbdChannels));
  EXPECT_EQ(channels[kRed].size(), cv::Size(256, 192));
  EXPECT_EQ(channels[kRed].at<uchar>(100, 100), 3);
  for (const int channel : {kInverseDepth, kHeight, kSlope})
    EXPECT_EQ(cv::countNonZero(channels[static_cast<std::size_t>(channel)]), 0);
}

TEST(RgbdChannelsTest, TooLittleDepthLevelsNothing) {
  cv::Mat depth = cv::Mat::zeros(kCamera.height, kCamera.width, CV_32F);
  EXPECT_FALSE(levelling(depth, kCamera));
  depth(cv::Rect(10, 10, 12, 12)).setTo(2);
  EXPECT_FALSE(levelling(depth, kCamera));
}

TEST(RgbdChannelsTest, ATableTopIsTheLowestLevelSurfaceWhereNoFloorIsSeen) {
  // Straight down on a plane .7 m below: nothing tells it from a floor.
  const cv::Mat depth(kCamera.height, kCamera.width, CV_32F, cv::Scalar(0.7));
  const auto found = levelling(roomDepth(leaning(40, 0), 0.7), kCamera);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->camera_height_m, 0.7, 0.02);
  const auto facing =
      levelling(depth, kCamera);  // a wall before the camera: level is not to be told, but up stays across it
  ASSERT_TRUE(facing);
  EXPECT_NEAR(facing->up.z(), 0, 0.05);
}

}  // namespace
}  // namespace roomgraph
