// SPDX-License-Identifier: BSD-3-Clause
// The whole tracker before something that shows more features than the room, and begins to move.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tracker.h"

namespace roomgraph::tracking {
namespace {

// A wall that goes from near to far, as one straight ahead would also show a camera that turns; a cupboard before it, with larger
// patterns.
constexpr double kWall_m = 2.6, kSlope = 0.6, kFront_m = 1.5;
struct Cupboard {
  double half_width_m, scale;  ///< of its patterns
};
constexpr double kDriven_m = 0.02, kPushed_m = 0.04;
constexpr int kStands = 6, kMoves = 8;  // images
constexpr float kPerMetre_px = 120, kMiddle_px = 800;

const cv::Mat& papers() {
  static const cv::Mat both = [] {
    cv::Mat cells(200, 400, CV_8UC1), out;
    cv::RNG(5).fill(cells, cv::RNG::UNIFORM, 0, 256);
    cv::resize(cells, out, {}, 8, 8, cv::INTER_NEAREST);
    cv::GaussianBlur(out, out, {}, 1.5);
    return out;
  }();
  return both;
}

// From a camera at x; the cupboard was pushed along x. The wall may be bare.
Frame roomFrom(double t, double x, double pushed_m, const Cupboard& cupboard, bool bare = false) {
  Frame frame;
  frame.t = t;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  frame.depth = cv::Mat(240, 320, CV_32FC1);
  cv::Mat along(240, 320, CV_32FC1), above(240, 320, CV_32FC1);  // in the papers
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d ray = frame.camera.backProject(u, v, 1);
      const double on_front = x + kFront_m * ray.x() - pushed_m;
      const bool is_front = std::abs(on_front) < cupboard.half_width_m;
      const double depth = is_front ? kFront_m : (kWall_m + kSlope * x) / (1 - kSlope * ray.x());
      const double scale = is_front ? cupboard.scale : 1, place = is_front ? scale * on_front + 9 : x + depth * ray.x();
      frame.depth.at<float>(v, u) = static_cast<float>(depth);
      along.at<float>(v, u) = kMiddle_px + kPerMetre_px * static_cast<float>(place);
      above.at<float>(v, u) = kMiddle_px + kPerMetre_px * static_cast<float>(scale * depth * ray.y());
    }
  cv::remap(papers(), frame.gray, along, above, cv::INTER_LINEAR);
  if (bare) frame.gray.setTo(128, frame.depth > kFront_m + 0.01);
  return frame;
}

// Half of the image, two thirds of it, and one whose features are like the wall's.
class PushedCupboard : public ::testing::TestWithParam<Cupboard> {};
INSTANTIATE_TEST_SUITE_P(TrackerMovers, PushedCupboard, ::testing::Values(Cupboard{0.3, 0.6}, Cupboard{0.36, 0.6}, Cupboard{0.42, 1}));

TEST_P(PushedCupboard, IsNotFollowed) {
  Tracker tracker(TrackingParameters{});
  const TrackingPrior wheels{.previous_from_current = poseFromYpr(kDriven_m, 0, 0, 0, 0, 0)};
  int seen_moving = 0;
  for (int i = 0; i < kStands + kMoves; ++i) {
    const double x = kDriven_m * i, pushed_m = -kPushed_m * std::max(0, i - kStands + 1);
    const TrackingResult result = tracker.track(roomFrom(0.1 * i, x, pushed_m, GetParam()), i == 0 ? TrackingPrior{} : wheels);
    ASSERT_TRUE(result.tracked) << i << ": " << result.reason;
    EXPECT_EQ(result.segment, 0) << i;
    if (i < kStands) {
      EXPECT_EQ(result.moving, 0) << i;
    }
    EXPECT_NEAR(result.odom_from_camera.translation().x(), x, 0.02) << i;
    seen_moving += result.moving > 0;
  }
  EXPECT_GT(seen_moving, 0);
}

// Where soon nothing but the cupboard shows features, wheels lead on.
TEST(TrackerMovers, WhatMovedAMomentAgoIsNotFollowedWhereNothingElseIsSeen) {
  Tracker tracker(TrackingParameters{});
  const TrackingPrior wheels{.previous_from_current = poseFromYpr(kDriven_m, 0, 0, 0, 0, 0)};
  constexpr int kBare = 3, kImages = 16, kFollows = 14;  // images after the push begins; in so many it must not be followed
  for (int i = 0; i < kStands + kImages; ++i) {
    const double x = kDriven_m * i, pushed_m = -kPushed_m * std::max(0, i - kStands + 1);
    const TrackingResult result = tracker.track(roomFrom(0.1 * i, x, pushed_m, {0.36, 0.6}, i >= kStands + kBare), i == 0 ? TrackingPrior{} : wheels);
    EXPECT_NEAR(result.odom_from_camera.translation().x(), x, 0.02) << i << ' ' << result.reason;
    if (i < kStands + kFollows) {
      EXPECT_EQ(result.segment, 0) << i << ' ' << result.reason;
    }
  }
}

}  // namespace
}  // namespace roomgraph::tracking
