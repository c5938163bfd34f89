// SPDX-License-Identifier: BSD-3-Clause
// Colour camera: exact without noise; vignetting and noise by their definition.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sensors.h"

namespace roomgraph {
namespace {

cv::Mat gray(double value) {
  return cv::Mat(200, 300, CV_8UC3, cv::Scalar(value, value, value));
}

cv::Mat lit(float share) {
  return cv::Mat(200, 300, CV_32F, cv::Scalar(share));
}

TEST(MeasureColor, WithoutNoiseItIsColourTimesLight) {
  CameraSpec spec;
  spec.noise_gain = 0;
  cv::Mat color = gray(0);
  color.at<cv::Vec3b>(0, 0) = {200, 100, 50};
  color.at<cv::Vec3b>(199, 299) = {40, 80, 160};
  const cv::Mat out = measureColor(color, lit(0.5f), spec, Random(1));
  EXPECT_EQ(out.at<cv::Vec3b>(0, 0), cv::Vec3b(100, 50, 25));
  EXPECT_EQ(out.at<cv::Vec3b>(199, 299), cv::Vec3b(20, 40, 80));
  EXPECT_EQ(cv::countNonZero(out.reshape(1)), 6);
}

TEST(MeasureColor, CornersAreDarkerBySixteenPercent) {
  const cv::Mat out = measureColor(gray(200), lit(1), CameraSpec{}, Random(1));
  const auto mean = [&](const cv::Rect& area) { return cv::mean(out(area))[1]; };
  EXPECT_NEAR(mean({140, 90, 20, 20}), 200, 1);
  // At the middle of the left border (150 px of the corner's 180 from the centre) and in the corner.
  EXPECT_NEAR(mean({0, 95, 10, 10}), 200 * (1 - 0.16 * (145.0 * 145) / (150.0 * 150 + 100 * 100)), 1);
  EXPECT_NEAR(mean({0, 0, 6, 6}), 200 * (1 - 0.16 * (147.0 * 147 + 97 * 97) / (150.0 * 150 + 100 * 100)), 1);
}

TEST(MeasureColor, NoiseIsCommonToTheChannelsAndGrowsWithItsGain) {
  const auto sigma = [](double gain) {
    CameraSpec spec;
    spec.noise_gain = gain;
    const cv::Mat out = measureColor(gray(128), lit(1), spec, Random(2))(cv::Rect(130, 80, 40, 40)).clone();
    std::vector<cv::Mat> channels;
    cv::split(out, channels);
    EXPECT_EQ(cv::norm(channels[0], channels[2], cv::NORM_INF), 0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(channels[0], mean, deviation);
    EXPECT_NEAR(mean[0], 128, 0.5);
    return deviation[0];
  };
  // Two uniform deviates of +-2.2: variance 2 (2.2 * 2)^2 / 12, and 1/12 of rounding.
  EXPECT_NEAR(sigma(1), std::sqrt(2 * 4.4 * 4.4 / 12 + 1 / 12.0), 0.1);
  EXPECT_NEAR(sigma(3), 3 * std::sqrt(2 * 4.4 * 4.4 / 12), 0.3);
}

}  // namespace
}  // namespace roomgraph
