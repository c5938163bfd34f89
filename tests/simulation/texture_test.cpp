// SPDX-License-Identifier: BSD-3-Clause
// Textures: colour, seamless repetition, variants and unknown patterns.
#include "texture.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

const std::array<double, 3> kBlueish{0.2, 0.4, 0.6};

/// Mean absolute difference of two columns, or rows when `rows`.
double difference(const cv::Mat& picture, int a, int b, bool rows) {
  return rows ? cv::norm(picture.row(a), picture.row(b), cv::NORM_L1) / picture.cols
              : cv::norm(picture.col(a), picture.col(b), cv::NORM_L1) / picture.rows;
}

TEST(Texture, EveryPatternIsASquarePictureThatDoesNotChange) {
  for (const auto& pattern : texturePatterns()) {
    const Material material{pattern, kBlueish, 1, 3};
    const cv::Mat picture = textureOf(material);
    EXPECT_EQ(picture.type(), CV_8UC3) << pattern;
    EXPECT_EQ(picture.rows, picture.cols) << pattern;
    EXPECT_EQ(cv::norm(picture, textureOf(material), cv::NORM_INF), 0) << pattern;
  }
}

TEST(Texture, TheChessboardHasNineBySixInnerCorners) {
  const cv::Mat picture = textureOf({kChessboardPattern, {0.9, 0.9, 0.9}, 1, 0});
  EXPECT_EQ(4 * picture.rows, 3 * picture.cols) << "12 by 9 squares";
  const int square = picture.cols / 12;
  int corners = 0;
  for (int row = 1; row < 9; ++row)
    for (int column = 1; column < 12; ++column) {
      const auto dark = [&](int r, int c) {
        return picture.at<cv::Vec3b>(r * square + square / 2, c * square + square / 2)[0] < 100;
      };
      const bool here = dark(row, column), left = dark(row, column - 1);
      corners += here != left && dark(row - 1, column) != here && dark(row - 1, column - 1) != left;
    }
  EXPECT_EQ(corners, 9 * 6);
}

TEST(Texture, SurfacesHaveTheMaterialsColour) {
  for (const std::string pattern :
       {"plain", "paint", "plaster", "carpet", "fabric", "leather", "wood", "metal", "leaf"}) {
    const cv::Scalar mean = cv::mean(textureOf({pattern, kBlueish, 1, 0}));
    for (int k = 0; k < 3; ++k)  // BGR
      EXPECT_NEAR(mean[k] / 255, kBlueish[static_cast<std::size_t>(2 - k)], 0.06 * kBlueish[2]) << pattern << k;
  }
  const cv::Mat plain = textureOf({"plain", kBlueish, 1, 0});
  EXPECT_EQ(plain.at<cv::Vec3b>(0, 0), cv::Vec3b(153, 102, 51));
  EXPECT_EQ(cv::norm(plain, cv::Mat(plain.size(), CV_8UC3, cv::Scalar(153, 102, 51)), cv::NORM_INF), 0);
}

TEST(Texture, SurfacesRepeatWithoutASeam) {
  for (const std::string pattern : {"paint", "plaster", "carpet", "fabric", "leather", "wood", "metal", "leaf"}) {
    const cv::Mat picture = textureOf({pattern, kBlueish, 1, 0});
    for (const bool rows : {false, true}) {
      double inside = 0;
      for (int i = 1; i < picture.cols; ++i) inside = std::max(inside, difference(picture, i - 1, i, rows));
      EXPECT_LE(difference(picture, picture.cols - 1, 0, rows), 1.2 * inside) << pattern << rows;
    }
  }
}

TEST(Texture, TilesHaveDarkJointsAndLightFaces) {
  const cv::Mat picture = textureOf({"tiles", {0.5, 0.5, 0.5}, 1, 0});
  for (const int joint : {0, 1, 128, 129}) {
    EXPECT_NEAR(picture.at<cv::Vec3b>(60, joint)[0], 0.6 * 127.5, 1);
    EXPECT_NEAR(picture.at<cv::Vec3b>(joint, 60)[0], 0.6 * 127.5, 1);
  }
  EXPECT_NEAR(cv::mean(picture(cv::Rect(4, 4, 120, 120)))[0], 127.5, 6);
}

TEST(Texture, PostersAndScreensDifferByVariant) {
  for (const std::string pattern : {"poster", "screen"}) {
    const cv::Mat a = textureOf({pattern, kBlueish, 1, 0}), b = textureOf({pattern, kBlueish, 1, 1});
    EXPECT_GT(cv::norm(a, b, cv::NORM_L1) / static_cast<double>(3 * a.total()), 10) << pattern;
  }
}

TEST(Texture, APictureOfAMeshFileIsTakenAsItIs) {
  const auto picture = std::make_shared<const cv::Mat>(5, 7, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat out = textureOf({"picture", {1, 1, 1}, 1, 0, picture});
  EXPECT_EQ(out.size(), cv::Size(7, 5));
  EXPECT_EQ(out.at<cv::Vec3b>(4, 6), cv::Vec3b(1, 2, 3));
}

TEST(Texture, AnUnknownPatternIsNamed) {
  EXPECT_THAT(test::messageOf<ConfigError>([] { textureOf({"marble", kBlueish, 1, 0}); }),
              ::testing::AllOf(::testing::HasSubstr("'marble'"), ::testing::HasSubstr("plaster")));
}

}  // namespace
}  // namespace roomgraph
