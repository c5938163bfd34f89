// SPDX-License-Identifier: BSD-3-Clause
// Letterbox and stretch mapping of images and boxes.
#include "input_mapping.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

TEST(InputMapping, LetterboxKeepsOneScaleAndPadsBelow) {
  const InputMapping mapping = mappingFor({640, 480}, {416, 416}, InputFit::kLetterboxTopLeft);
  EXPECT_DOUBLE_EQ(mapping.scale_x, 416.0 / 640);
  EXPECT_DOUBLE_EQ(mapping.scale_y, 416.0 / 640);
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat input = fitImage(image, {416, 416}, InputFit::kLetterboxTopLeft, 114);
  EXPECT_EQ(input.at<cv::Vec3b>(311, 415), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(input.at<cv::Vec3b>(312, 0), cv::Vec3b(114, 114, 114));
}

TEST(InputMapping, TallImageIsLimitedByItsHeight) {
  EXPECT_DOUBLE_EQ(mappingFor({200, 800}, {416, 416}, InputFit::kLetterboxTopLeft).scale_x, 416.0 / 800);
  const cv::Mat input =
      fitImage(cv::Mat(800, 200, CV_8UC1, cv::Scalar(7)), {416, 416}, InputFit::kLetterboxTopLeft, 1);
  EXPECT_EQ(input.at<uchar>(415, 103), 7);
  EXPECT_EQ(input.at<uchar>(415, 104), 1);
}

TEST(InputMapping, StretchScalesEachAxis) {
  const InputMapping mapping = mappingFor({640, 480}, {320, 320}, InputFit::kStretch);
  const Box2 box = mapping.toImage({0, 0, 320, 320});
  EXPECT_DOUBLE_EQ(box.u_max, 640);
  EXPECT_DOUBLE_EQ(box.v_max, 480);
}

TEST(InputMapping, RoundTrip) {
  const Box2 box{12.25, 80, 333, 470.5};
  for (const InputFit fit : {InputFit::kStretch, InputFit::kLetterboxTopLeft}) {
    const InputMapping mapping = mappingFor({640, 480}, {416, 320}, fit);
    const Box2 back = mapping.toImage(mapping.toInput(box));
    EXPECT_NEAR(back.u_min, box.u_min, 1e-9);
    EXPECT_NEAR(back.v_min, box.v_min, 1e-9);
    EXPECT_NEAR(back.u_max, box.u_max, 1e-9);
    EXPECT_NEAR(back.v_max, box.v_max, 1e-9);
  }
}

}  // namespace
}  // namespace roomgraph
