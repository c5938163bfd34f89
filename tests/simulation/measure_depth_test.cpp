// SPDX-License-Identifier: BSD-3-Clause
// Depth noise model: growth with range, disparity steps, limits and projector shadow.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "sensors.h"

namespace roomgraph {
namespace {

cv::Mat wall(float z) {
  return cv::Mat(480, 640, CV_32F, cv::Scalar(z));
}

struct Spread {
  double mean = 0, sigma = 0;
  int count = 0;
};

Spread spread(const cv::Mat& depth) {
  Spread out;
  double sum = 0, squares = 0;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u)
      if (const double z = depth.at<std::uint16_t>(v, u) * 0.001; z > 0) {
        sum += z;
        squares += z * z;
        ++out.count;
      }
  out.mean = sum / out.count;
  out.sigma = std::sqrt(squares / out.count - out.mean * out.mean);
  return out;
}

TEST(MeasureDepth, NoiseGrowsAsTheModelSays) {
  for (const float z : {1.0f, 2.0f, 3.0f, 4.5f}) {
    const auto measured = spread(measureDepth(wall(z), CameraSpec{}, Random(3, 1, 0)));
    const double noise = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    const double step = z * z / (0.075 * 580) / 8, expected = std::hypot(noise, step / std::sqrt(12));
    EXPECT_NEAR(measured.mean, z, 0.2 * step + 0.1 * noise + 0.0006) << z;
    EXPECT_NEAR(measured.sigma, expected, 0.2 * expected) << z;
    EXPECT_EQ(measured.count, 640 * 480);
  }
}

TEST(MeasureDepth, DisparityComesInEighths) {
  const cv::Mat depth = measureDepth(wall(4), CameraSpec{}, Random(3, 1, 0));
  std::set<int> steps;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const double eighths = 8 * 0.075 * 580 / (0.001 * depth.at<std::uint16_t>(v, u));
      EXPECT_NEAR(eighths, std::round(eighths), 0.02);
      steps.insert(static_cast<int>(std::lround(eighths)));
    }
  EXPECT_GE(steps.size(), 3u);
}

TEST(MeasureDepth, NothingTooNearNorTooFar) {
  EXPECT_EQ(cv::countNonZero(measureDepth(wall(0.4f), CameraSpec{}, Random(3))), 0);
  EXPECT_EQ(cv::countNonZero(measureDepth(wall(5.2f), CameraSpec{}, Random(3))), 0);
}

TEST(MeasureDepth, WithoutNoiseItIsExactToTheUnit) {
  CameraSpec spec;
  spec.noise_gain = 0;
  const auto measured = spread(measureDepth(wall(3.2104f), spec, Random(3)));
  EXPECT_NEAR(measured.mean, 3.210, 1e-6);
}

TEST(MeasureDepth, TheProjectorsShadowFallsToTheLeftOfNearThings) {
  cv::Mat depth = wall(3);
  depth(cv::Rect(300, 0, 100, 480)) = 1;
  const cv::Mat measured = measureDepth(depth, CameraSpec{}, Random(3));
  // Disparities differ by 0.075 * 525 * (1 - 1/3) = 26 px: that wide is the shadow.
  EXPECT_EQ(cv::countNonZero(measured(cv::Rect(276, 0, 22, 480))), 0);
  EXPECT_EQ(cv::countNonZero(measured(cv::Rect(200, 0, 70, 480))), 70 * 480);
  EXPECT_EQ(cv::countNonZero(measured(cv::Rect(405, 0, 70, 480))), 70 * 480);
  // The edge itself is ragged.
  const int edge = cv::countNonZero(measured(cv::Rect(399, 0, 1, 480)));
  EXPECT_GT(edge, 100);
  EXPECT_LT(edge, 300);
}

}  // namespace
}  // namespace roomgraph
