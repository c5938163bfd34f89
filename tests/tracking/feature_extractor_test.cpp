// SPDX-License-Identifier: BSD-3-Clause
// Feature grid against brute force, feature extraction and matching on rendered images.
#include "feature_extractor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <tuple>

#include "matcher.h"
#include "textured_room.h"

namespace roomgraph::tracking {
namespace {

TEST(FeatureGrid, FindsWhatBruteForceFinds) {
  std::mt19937 random(3);
  std::vector<FeaturePlace> places;
  for (int i = 0; i < 500; ++i) {
    const auto u = static_cast<float>(random() % 3200) / 10, v = static_cast<float>(random() % 2400) / 10;
    places.push_back({{u, v}});
  }
  const FeatureGrid grid(places, 320, 240);
  for (int round = 0; round < 50; ++round) {
    const double u = static_cast<double>(random() % 340) - 10, v = static_cast<double>(random() % 260) - 10;
    std::vector<int> found, expected;
    grid.query(u, v, 25, found);
    for (int i = 0; i < 500; ++i)
      if (std::hypot(places[static_cast<std::size_t>(i)].pt.x - u,
                     places[static_cast<std::size_t>(i)].pt.y - v) <= 25)
        expected.push_back(i);
    // Matching takes the first of equally good ones: by rows of cells, in a row by column, in a cell by index.
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [&](int a, int b) {
      const auto key = [&](int i) {
        const cv::Point2f& p = places[static_cast<std::size_t>(i)].pt;
        return std::tuple(static_cast<int>(p.y) / 16, static_cast<int>(p.x) / 16, i);
      };
      return key(a) < key(b);
    }));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(FeatureExtractor, SpreadsFeaturesEvenly) {
  // Strong corners on the left half, weak ones on the right: both halves must get features.
  const test::TexturedRoom room;
  Frame frame = room.render(0, Pose3::Identity());
  cv::Mat right = frame.gray.colRange(160, 320);
  right.convertTo(right, CV_8U, 0.3, 90);
  const auto features = extractFeatures(frame.gray, frame, {}, {});
  int left = 0;
  for (const auto& k : features.places) left += k.pt.x < 160;
  EXPECT_GT(features.size(), 500u);
  EXPECT_GT(static_cast<int>(features.size()) - left, left / 2);
}

TEST(FeatureExtractor, LeavesOutExcludedBoxes) {
  const test::TexturedRoom room;
  const Frame frame = room.render(0, Pose3::Identity());
  const Box2 box{100, 60, 220, 180};
  const auto inside = [&](const Features& features) {
    return std::count_if(features.places.begin(), features.places.end(),
                         [&](const FeaturePlace& k) { return box.contains(k.pt.x, k.pt.y); });
  };
  EXPECT_GT(inside(extractFeatures(frame.gray, frame, {}, {})), 50);
  // Coarse levels round to their own pixels.
  const Box2 inner{box.u_min + 3, box.v_min + 3, box.u_max - 3, box.v_max - 3};
  for (const auto& k : extractFeatures(frame.gray, frame, {box}, {}).places)
    EXPECT_FALSE(inner.contains(k.pt.x, k.pt.y));
}

// Centres of round spots are found where they are, also on a coarse level: resizing maps pixel centres, which moves
// coordinates by half of (scale - 1) pixels.
TEST(FeatureExtractor, CoarseLevelsDoNotMoveTheFeatures) {
  TrackingParameters parameters;
  constexpr int kLevel = 4;
  const double scale = std::pow(parameters.scale_factor, kLevel);
  // The level has a whole number of pixels: 243 x 190.
  Frame frame;
  frame.gray = cv::Mat(394, 504, CV_8U);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> within(0, 8);
  std::vector<Eigen::Vector2d> spots;
  for (double v = 46; v < 344; v += 34)
    for (double u = 46; u < 454; u += 34) spots.emplace_back(u + within(random), v + within(random));
  const auto nearest = [&](double u, double v) {
    return *std::min_element(spots.begin(), spots.end(), [&](const auto& a, const auto& b) {
      return (a - Eigen::Vector2d(u, v)).norm() < (b - Eigen::Vector2d(u, v)).norm();
    });
  };
  for (int v = 0; v < frame.gray.rows; ++v)
    for (int u = 0; u < frame.gray.cols; ++u)
      frame.gray.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(
          std::lround(40 + 180 * std::exp(-(nearest(u, v) - Eigen::Vector2d(u, v)).squaredNorm() / (2 * 4.0 * 4.0))));
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  int count = 0;
  for (const auto& k : extractFeatures(frame.gray, frame, {}, parameters).places) {
    if (k.octave != kLevel) continue;
    const Eigen::Vector2d error = Eigen::Vector2d(k.pt.x, k.pt.y) - nearest(k.pt.x, k.pt.y);
    ASSERT_LT(error.norm(), 3) << "a corner beside the spots";
    offset += error;
    ++count;
  }
  ASSERT_GT(count, 60);
  EXPECT_LT((offset / count).cwiseAbs().maxCoeff(), 0.2) << "against a shift by " << (scale - 1) / 2;
}

TEST(FeatureExtractor, DropsDepthAtEdges) {
  const test::TexturedRoom room;
  Frame frame = room.render(0, Pose3::Identity());
  frame.depth.setTo(2.F);
  frame.depth.colRange(160, 320).setTo(3.F);
  const auto features = extractFeatures(frame.gray, frame, {}, {});
  for (std::size_t i = 0; i < features.size(); ++i) {
    const float u = features.places[i].pt.x;
    if (u < 155) {
      EXPECT_FLOAT_EQ(features.depth[i], 2);
    }
    if (u > 158.6 && u < 160.4) {
      EXPECT_EQ(features.depth[i], 0) << u;
    }
    if (u > 165) {
      EXPECT_FLOAT_EQ(features.depth[i], 3);
    }
  }
}

TEST(Matcher, FindsTheSameFeaturesInTheSameImage) {
  const test::TexturedRoom room;
  const Frame frame = room.render(0, Pose3::Identity());
  const auto features = extractFeatures(frame.gray, frame, {}, {});
  const auto matches = matchDescriptors(features.descriptors, features.descriptors, {});
  EXPECT_GT(matches.size(), features.size() / 2);
  for (const auto& [a, b] : matches) EXPECT_EQ(a, b);
}

TEST(Matcher, CountsDifferingBits) {
  Descriptor a{}, b{};
  b[0] = 0xF0;
  b[31] = 0x01;
  EXPECT_EQ(hammingDistance(a, b), 5);
}

}  // namespace
}  // namespace roomgraph::tracking
