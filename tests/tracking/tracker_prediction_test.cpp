// SPDX-License-Identifier: BSD-3-Clause
// Views that are not where other sensors say.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr double kDepth_m = 2, kStep_m = 0.03;
constexpr int kPeriod_px = 48;

// A wall straight ahead with one pattern again and again: only near where it is expected a feature can be told from its likes.
Frame wallpaperFrom(double t, double x) {
  Frame frame;
  frame.t = t;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  cv::Mat tile(kPeriod_px / 4, kPeriod_px / 4, CV_8UC1), wall;
  cv::RNG(5).fill(tile, cv::RNG::UNIFORM, 0, 256);
  cv::resize(tile, tile, {kPeriod_px, kPeriod_px}, 0, 0, cv::INTER_NEAREST);
  wall = cv::repeat(tile, 6, 24);
  cv::GaussianBlur(wall, wall, {}, 1.0);
  const double shift_px = frame.camera.fx * x / kDepth_m;
  const cv::Mat move = (cv::Mat_<double>(2, 3) << 1, 0, -shift_px - 5 * kPeriod_px, 0, 1, 0);
  cv::warpAffine(wall, frame.gray, move, {frame.camera.width, frame.camera.height});
  frame.depth = cv::Mat(frame.gray.size(), CV_32FC1, cv::Scalar(kDepth_m));
  return frame;
}

Pose3 movedBy(double x) {
  return poseFromYpr(x, 0, 0, 0, 0, 0);
}

// Where the sixth frame is said to be when other sensors were right until then.
TrackingResult sixthFrame(double by_sensors_m) {
  TrackingParameters parameters;
  parameters.dense_alignment = false;
  Tracker tracker(parameters);
  EXPECT_TRUE(tracker.track(wallpaperFrom(0, 0), {}).tracked);
  for (int i = 1; i < 5; ++i)
    EXPECT_TRUE(tracker.track(wallpaperFrom(i, kStep_m * i), {.previous_from_current = movedBy(kStep_m)}).tracked) << i;
  return tracker.track(wallpaperFrom(5, 5 * kStep_m), {.previous_from_current = movedBy(by_sensors_m)});
}

TEST(TrackerPrediction, AViewIsFoundWhereWheelsSlip) {
  for (const double by_wheels : {kStep_m, kStep_m + 0.18}) {
    const TrackingResult result = sixthFrame(by_wheels);
    ASSERT_TRUE(result.tracked) << by_wheels << ": " << result.reason;
    EXPECT_NEAR(result.odom_from_camera.translation().x(), 5 * kStep_m, 0.005) << by_wheels;
    EXPECT_EQ(result.segment, 0);
  }
}

}  // namespace
}  // namespace roomgraph::tracking
