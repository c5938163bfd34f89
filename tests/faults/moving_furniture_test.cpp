// SPDX-License-Identifier: BSD-3-Clause
// A cupboard in scans and images: where it is by hand, what hides it, and where nothing is known of the robot.
#include "moving_furniture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "passing_records.h"

namespace roomgraph {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr FaultWindow kWindow{1, 9};
constexpr double kSpeed = 1;      // m/s: after one second, and three, it is straight ahead of where the robot was
constexpr float kFront_m = 1.6f;  // of the cupboard: 1.8 m less half of 0.4

PassingRecord wideScan(double t, float range) {
  auto scan = makeScan(kStart_s + t, range, 41);
  for (std::size_t i = 0; i < scan->getScanSize(); ++i) scan->setScanRange(i, range);
  scan->sensorPose = {0, 0, 0.3, 0, 0, 0};
  return passing(scan);
}

PassingRecord view(double t) {
  auto images = makeImages(kStart_s + t, 40, 30);
  images->sensorPose = {0, 0, 0.6, 0, 0, 0};
  Pose3 optical = Pose3::Identity();
  optical.linear() = bodyFromOptical();
  images->relativePoseIntensityWRTDepth = toMrpt(optical);
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) images->rangeImage(v, u) = 3000;
  return passing(images);
}

PassingRecord standing(double t) { return odometryAt(t, 0); }

TEST(MovingFurniture, RaysEnterTheBoxWhereTheyMeetItsSides) {
  EXPECT_DOUBLE_EQ(entersBox({-2, 0.1, 0.5}, {1, 0, 0}).value(), 1.8);
  EXPECT_DOUBLE_EQ(entersBox({-2, 0.1, 0.5}, {2, 0, 0}).value(), 0.9);
  EXPECT_DOUBLE_EQ(entersBox({0.1, 0, 3}, {0, 0, -1}).value(), 1.8);
  const double diagonal = std::sqrt(2.0);
  EXPECT_NEAR(entersBox({-2, -2, 0.5}, Vector3d(1, 1, 0) / diagonal).value(), 1.8 * diagonal, 1e-12);
  EXPECT_FALSE(entersBox({-2, 0.31, 0.5}, {1, 0, 0}));
  EXPECT_FALSE(entersBox({-2, 0, 1.21}, {1, 0, 0}));
  EXPECT_FALSE(entersBox({-2, 0, 0.5}, {-1, 0, 0})) << "it is behind";
  EXPECT_FALSE(entersBox({0, 0, 0.5}, {1, 0, 0})) << "it begins inside";
}

TEST(MovingFurniture, ItIsPushedToAndFro) {
  MovingBox box;
  box.speed_m_s = 0.5;
  box.odom_from_robot = toPose3(Pose2{1, 0, M_PI / 2});
  const auto expectAt = [&](double seconds, double aside) {
    const Vector3d at = box.odom_from_box(seconds).translation();
    EXPECT_NEAR((at - Vector3d(1 - aside, 1.8, 0)).norm(), 0, 1e-12) << seconds;
  };
  for (const auto& [seconds, aside] : {std::pair(0.0, 1.0), {1.0, 0.5}, {2.0, 0.0}, {4.0, -1.0}, {6.0, 0.0}, {8.0, 1.0}, {10.0, 0.0}})
    expectAt(seconds, aside);
}

TEST(MovingFurniture, BeamsEndAtItUnlessSomethingIsNearer) {
  MovingFurnitureFault fault(kWindow, kSpeed);
  auto far = wideScan(2, 4), near = wideScan(2, 1.5f);
  auto& blind = dynamic_cast<mrpt::obs::CObservation2DRangeScan&>(*far.observation);
  blind.setScanRangeValidity(20, false);
  const auto out = through(fault, {standing(0), wideScan(1, 4), far, near});
  const auto& scan = scanOf(out[2]);
  EXPECT_FLOAT_EQ(scan.getScanRange(20), kFront_m);
  EXPECT_TRUE(scan.getScanRangeValidity(20));
  const double step = 2.0 / 40;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const double angle = (static_cast<double>(i) - 20) * step;
    const bool on_front = std::abs(kFront_m * std::tan(angle)) < 0.3;
    EXPECT_NEAR(scan.getScanRange(i), on_front ? kFront_m / std::cos(angle) : 4, 1e-5) << i;
  }
  EXPECT_TRUE(keepsBytes(out[3])) << "all of it is hidden";
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 2}}));
}

TEST(MovingFurniture, PixelsShowItWhereDepthDoes) {
  MovingFurnitureFault fault(kWindow, kSpeed);
  auto shown = view(2);
  auto& before = dynamic_cast<mrpt::obs::CObservation3DRangeScan&>(*shown.observation);
  before.rangeImage(15, 19) = 1000;
  before.rangeImage(15, 20) = 0;
  const auto out = through(fault, {standing(0), wideScan(1, 4), shown});
  const auto& images = imagesOf(out[2]);
  const cv::Mat pixels = images.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  EXPECT_EQ(images.rangeImage(15, 19), 1000);
  int painted = 0;
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) {
      // The camera, .6 m high, looks at the middle of the front.
      const double y = kFront_m * (u - 19.5) / 20, z = kFront_m * (v - 14.5) / 20;
      const bool front = std::abs(y) < 0.3 && std::abs(z) < 0.6 && !(v == 15 && u == 19);
      if (front) {
        EXPECT_EQ(images.rangeImage(v, u), 1600) << u << ' ' << v;
      }
      const auto& pixel = pixels.at<cv::Vec3b>(v, u);
      EXPECT_EQ(pixel[0] == pixel[1] && pixel[1] == pixel[2], front) << u << ' ' << v;
      painted += front;
    }
  EXPECT_GT(painted, 60);
}

TEST(MovingFurniture, RangesAlongRaysAreLongerThanDepths) {
  MovingFurnitureFault fault(kWindow, kSpeed);
  auto shown = view(2);
  dynamic_cast<mrpt::obs::CObservation3DRangeScan&>(*shown.observation).range_is_depth = false;
  const auto out = through(fault, {standing(0), wideScan(1, 4), shown});
  EXPECT_NEAR(imagesOf(out[2]).rangeImage(10, 17), 1600 * std::hypot(1.0, 2.5 / 20, 4.5 / 20), 1);
}

TEST(MovingFurniture, WheelsSayWhereTheRobotIsAlsoBetweenReadings) {
  MovingFurnitureFault fault(kWindow, kSpeed);
  const auto out = through(fault, {standing(0), wideScan(1, 4), standing(1.5), odometryAt(1.9, 0.4), wideScan(2, 4)});
  EXPECT_NEAR(scanOf(out[4]).getScanRange(20), kFront_m - 0.5f, 1e-5) << "half a metre on, of which a tenth was not read yet";
}

TEST(MovingFurniture, NothingIsDrawnWithoutWheelsOutsideTheTimeOrIntoTheRobot) {
  MovingFurnitureFault fault(kWindow, kSpeed);
  const auto out = through(fault, {wideScan(2, 4), view(2), standing(2), wideScan(0.9, 4), wideScan(9, 4), boxesAt(3)});
  for (const auto& record : out) EXPECT_TRUE(keepsBytes(record));
  MovingFurnitureFault two(kWindow, kSpeed);
  auto fused = odometryAt(0.5, 7);
  fused.observation->sensorLabel = "FUSED";
  EXPECT_NEAR(scanOf(through(two, {standing(0), wideScan(1, 4), fused, wideScan(2, 4)})[3]).getScanRange(20), kFront_m, 1e-5) << "the first wheels count";
  MovingFurnitureFault close(kWindow, kSpeed);
  const auto inside = through(close, {standing(0), wideScan(1, 4), odometryAt(2, 1.5), wideScan(2, 4)});
  EXPECT_TRUE(keepsBytes(inside[3]));
}

}  // namespace
}  // namespace roomgraph
