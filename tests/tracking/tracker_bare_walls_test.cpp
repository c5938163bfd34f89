// SPDX-License-Identifier: BSD-3-Clause
// The whole tracker, by its camera alone, along walls without features: which velocity goes on.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr double kFrame_s = 1.0 / 30;
constexpr float kMiddleOfPaper_px = 600;

const cv::Mat& wallpaper() {
  static const cv::Mat paper = [] {
    cv::Mat cells(150, 900, CV_8UC1), out;
    cv::RNG(5).fill(cells, cv::RNG::UNIFORM, 0, 256);
    cv::resize(cells, out, {}, 8, 8, cv::INTER_NEAREST);
    cv::GaussianBlur(out, out, {}, 1.5);
    return out;
  }();
  return paper;
}

// A wall straight ahead of a camera that has moved by x along it; a bare one shows nothing but its depth.
Frame wallFrom(double t, double x, double depth_m, bool bare) {
  Frame frame;
  frame.t = t;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  frame.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(depth_m));
  cv::Mat along(240, 320, CV_32FC1), above(240, 320, CV_32FC1);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d seen = frame.camera.backProject(u, v, depth_m);
      along.at<float>(v, u) = 1500 + 120 * static_cast<float>(x + seen.x());
      above.at<float>(v, u) = kMiddleOfPaper_px + 120 * static_cast<float>(seen.y());
    }
  cv::remap(wallpaper(), frame.gray, along, above, cv::INTER_LINEAR);
  if (bare) frame.gray.setTo(128);
  return frame;
}

// Sideways at .3 m/s, and of every so many frames one shows features: what it corrects is drift, not a velocity.
TEST(TrackerBareWalls, AGlimpseOfFeaturesDoesNotMakeTheDriftAVelocity) {
  for (const int bare : {3, 4, 6, 30}) {
    Tracker tracker{TrackingParameters{}};
    int i = 0;
    double largest_m = 0;
    const auto see = [&](bool is_bare) {
      const double t = kFrame_s * i++, x = 0.3 * t;
      largest_m = std::max(largest_m, std::abs(tracker.track(wallFrom(t, x, 2, is_bare), {}).odom_from_camera.translation().x() - x));
    };
    for (int k = 0; k < 10; ++k) see(false);
    for (int cycle = 0; cycle < 12; ++cycle)
      for (int k = 0; k <= bare; ++k) see(k < bare);
    EXPECT_LT(largest_m, bare == 30 ? 0.32 : 0.08) << "of " << bare << " bare ones, in 30 of which it moves by .3 m: six metres once";
  }
}

// Straight at the wall, whose depth tells all of the movement; some frames never come.
TEST(TrackerBareWalls, AVelocityGoesOnForTheTimeThatPassed) {
  for (const double speed : {0.8, 1.2})
    for (const int dropped : {0, 10, 5}) {
      Tracker tracker{TrackingParameters{}};
      double error_m = 0;
      for (int i = 0; i < 90; ++i) {
        if (dropped > 0 && i > 12 && i % dropped == 0) continue;
        const double z = speed * kFrame_s * i;
        error_m = tracker.track(wallFrom(kFrame_s * i, 0, 6 - z, i > 10), {}).odom_from_camera.translation().z() - z;
      }
      EXPECT_LT(std::abs(error_m), 0.03) << speed << " m/s, every " << dropped << "th is missing";
    }
}

}  // namespace
}  // namespace roomgraph::tracking
