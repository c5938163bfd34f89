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

// The corners of the picture inside the input are the corners of the image.
TEST(InputMapping, CornersOfTheInputAreCornersOfTheImage) {
  const Box2 letterboxed =
      mappingFor({640, 480}, {416, 320}, InputFit::kLetterboxTopLeft).toImage({0, 0, 416, 312});
  EXPECT_NEAR(letterboxed.u_max, 640, 1e-9);
  EXPECT_NEAR(letterboxed.v_max, 480, 1e-9);
  const Box2 inner = mappingFor({640, 480}, {320, 320}, InputFit::kStretch).toImage({80, 160, 240, 200});
  EXPECT_NEAR(inner.u_min, 160, 1e-9);
  EXPECT_NEAR(inner.v_min, 240, 1e-9);
  EXPECT_NEAR(inner.u_max, 480, 1e-9);
  EXPECT_NEAR(inner.v_max, 300, 1e-9);
}

}  // namespace
}  // namespace roomgraph
