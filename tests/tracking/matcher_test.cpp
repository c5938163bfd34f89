// SPDX-License-Identifier: BSD-3-Clause
// Descriptor matching and projection search against brute force, thumbnails and the choice of loop candidates.
#include "matcher.h"

#include <gmock/gmock.h>

#include <map>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "place_recognition.h"

namespace roomgraph::tracking {
namespace {

using ::testing::ElementsAre;

Descriptor randomDescriptor(std::mt19937& random) {
  Descriptor out;
  for (auto& byte : out) byte = static_cast<std::uint8_t>(random() % 256);
  return out;
}

/// The descriptor with so many of its bits turned over.
Descriptor flipped(Descriptor descriptor, int bits, std::mt19937& random) {
  std::set<unsigned> chosen;
  while (static_cast<int>(chosen.size()) < bits) chosen.insert(static_cast<unsigned>(random() % 256));
  for (const unsigned bit : chosen) descriptor[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  return descriptor;
}

int bitsApart(const Descriptor& a, const Descriptor& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) count += ((a[i] ^ b[i]) >> bit) & 1;
  return count;
}

TEST(Matcher, HammingDistanceCountsBits) {
  std::mt19937 random(1);
  const Descriptor a = randomDescriptor(random);
  EXPECT_EQ(hammingDistance(a, a), 0);
  for (const int bits : {1, 17, 256}) EXPECT_EQ(hammingDistance(a, flipped(a, bits, random)), bits);
}

TEST(Matcher, DescriptorMatchesAreThoseOfBruteForce) {
  std::mt19937 random(2);
  TrackingParameters parameters;
  std::vector<Descriptor> a, b;
  for (int i = 0; i < 40; ++i) {
    a.push_back(randomDescriptor(random));
    const int bits = static_cast<int>(random() % 100);
    b.push_back(flipped(a.back(), bits, random));
    if (i % 5 == 0) b.push_back(flipped(a.back(), bits + 1, random));  // ambiguous
    if (i % 7 == 0) a.push_back(flipped(a.back(), 20, random));  // two of a want one of b
  }
  // Every a asks for its nearest b, which must be clearly nearer than the second; of several the nearest a gets it.
  std::map<int, std::pair<int, int>> asked;  // b: distance, a
  for (int i = 0; i < static_cast<int>(a.size()); ++i) {
    std::vector<std::pair<int, int>> order;
    for (int j = 0; j < static_cast<int>(b.size()); ++j)
      order.emplace_back(bitsApart(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(j)]), j);
    std::sort(order.begin(), order.end());
    if (order[0].first > parameters.max_hamming || order[0].first > parameters.match_ratio * order[1].first) continue;
    const std::pair<int, int> request{order[0].first, i};
    const auto [entry, added] = asked.emplace(order[0].second, request);
    if (!added && request.first < entry->second.first) entry->second = request;
  }
  std::vector<std::pair<int, int>> expected;
  for (const auto& [j, request] : asked) expected.emplace_back(request.second, j);
  EXPECT_GT(expected.size(), 15u);
  EXPECT_LT(expected.size(), 40u);
  EXPECT_EQ(matchDescriptors(a, b, parameters), expected);
  EXPECT_TRUE(matchDescriptors(a, {b[0]}, parameters).empty()) << "no second nearest to compare with";
}

/// A point straight ahead at 2 m, seen from the origin on level 2, and a feature where it is expected.
struct OnePoint {
  LocalMap map;
  PinholeCamera camera{640, 480, 500, 500, 320, 240, {}};
  Features features;
  TrackingParameters parameters;
  std::mt19937 random{7};

  OnePoint() {
    MapPoint point;
    point.position = {0, 0, 2};
    point.direction = {0, 0, 1};
    point.octave = 2;
    point.distance = 2;
    point.descriptor = randomDescriptor(random);
    map.points.add() = point;
  }
  void addFeature(double u, double v, int octave, int bits) {
    features.places.push_back({cv::Point2d(u, v), octave});
    features.descriptors.push_back(flipped(map.point(0).descriptor, bits, random));
    features.depth.push_back(0);
  }
  /// Feature that is found from `pose`, -1: none.
  int search(const Pose3& odom_from_camera, std::vector<std::int64_t> taken = {}) {
    features.grid = FeatureGrid(features.places, camera.width, camera.height);
    taken.resize(features.size(), -1);
    const Pose3 camera_from_odom = odom_from_camera.inverse();
    const auto found =
        ProjectionSearch{map, camera, camera_from_odom, 10}.match({0}, features, taken, parameters);
    EXPECT_LE(found.size(), 1u);
    return found.empty() ? -1 : found[0].feature;
  }
};

TEST(ProjectionSearch, TakesTheNearestDescriptorWithinTheRadius) {
  OnePoint p;
  p.addFeature(320 + 14.3, 240, 2, 20);  // the radius on level 2 is 10 * 1.2^2 = 14.4 px
  EXPECT_EQ(p.search(Pose3::Identity()), 0);
  p.addFeature(320, 240 + 14.5, 2, 0);  // just outside
  EXPECT_EQ(p.search(Pose3::Identity()), 0);
  p.addFeature(321, 240, 2, 5);
  EXPECT_EQ(p.search(Pose3::Identity()), 2);
  EXPECT_EQ(p.search(Pose3::Identity(), {-1, -1, 4}), 0) << "taken";
  p.addFeature(322, 241, 2, 5);
  EXPECT_EQ(p.search(Pose3::Identity()), -1) << "ambiguous";
}

TEST(ProjectionSearch, ExpectsAnotherLevelFromAnotherDistance) {
  OnePoint p;
  for (int octave = 0; octave < 8; ++octave) {
    p.features = {};
    p.addFeature(320, 240, octave, 0);
    const auto from = [&](double z) {
      Pose3 pose = Pose3::Identity();
      pose.translation().z() = z;
      return p.search(pose) == 0;
    };
    EXPECT_EQ(from(0), octave >= 1 && octave <= 3) << octave;
    // From half the distance it is as large as 4 levels higher: log 2 / log 1.2 = 3.8.
    EXPECT_EQ(from(1), octave >= 5 && octave <= 7) << octave;
    EXPECT_EQ(from(-4), octave <= 1) << octave;  // three times the distance: level 0 is the lowest
  }
}

TEST(ProjectionSearch, LooksOnlyForWhatCanBeSeen) {
  OnePoint p;
  p.addFeature(320, 240, 2, 0);
  p.addFeature(30, 240, 2, 0);
  std::vector<std::int64_t> in_view;
  const auto seen = [&](const Pose3& odom_from_camera) {
    p.features.grid = FeatureGrid(p.features.places, 640, 480);
    const Pose3 camera_from_odom = odom_from_camera.inverse();
    in_view.clear();
    ProjectionSearch{p.map, p.camera, camera_from_odom, 10}.match({0}, p.features, {-1, -1}, p.parameters, &in_view);
    return !in_view.empty();
  };
  EXPECT_TRUE(seen(Pose3::Identity()));
  Pose3 behind = Pose3::Identity();
  behind.translation().z() = 3;
  EXPECT_FALSE(seen(behind));
  Pose3 aside = Pose3::Identity();
  aside.translation().x() = 1.3;  // the image reaches 1.28 m to its left at 2 m
  EXPECT_FALSE(seen(aside));
  const auto around = [](double angle) {  // on a circle around the point
    Pose3 pose = Pose3::Identity();
    pose.linear() = expSO3({0, angle, 0});
    pose.translation() = Eigen::Vector3d(0, 0, 2) - pose.linear() * Eigen::Vector3d(0, 0, 2);
    return pose;
  };
  EXPECT_TRUE(seen(around(1.0)));
  EXPECT_FALSE(seen(around(1.1))) << "more than 60 degrees";
  p.map.point(0).erased = true;
  EXPECT_FALSE(seen(Pose3::Identity()));
}

TEST(Thumbnail, HasZeroMeanAndUnitNormWhateverTheLight) {
  cv::Mat gray(240, 320, CV_8U);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      gray.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(40 + (u / 40 * 37 + v / 30 * 53) % 100);
  const cv::Mat thumbnail = makeThumbnail(gray);
  EXPECT_EQ(thumbnail.size(), cv::Size(40, 30));
  EXPECT_NEAR(cv::mean(thumbnail)[0], 0, 1e-6);
  EXPECT_NEAR(cv::norm(thumbnail), 1, 1e-5);
  cv::Mat brighter;
  gray.convertTo(brighter, CV_8U, 1.5, 20);
  EXPECT_NEAR(similarity(makeThumbnail(brighter), thumbnail), 1, 1e-3);
  EXPECT_EQ(cv::norm(makeThumbnail(cv::Mat(240, 320, CV_8U, cv::Scalar(90)))), 0) << "nothing to see";
}

/// Keyframes 1 m apart along x whose thumbnails are unit vectors: keyframe i looks like keyframe like[i].
LocalMap rowOf(const std::vector<int>& like) {
  LocalMap map;
  for (std::size_t i = 0; i < like.size(); ++i) {
    Keyframe keyframe;
    keyframe.odom_from_camera.translation().x() = static_cast<double>(i);
    keyframe.thumbnail = cv::Mat::zeros(30, 40, CV_32F);
    keyframe.thumbnail.at<float>(0, like[i]) = 1;
    map.keyframes.push_back(keyframe);
  }
  return map;
}

TEST(LoopCandidates, AreSimilarOldKeyframesAndTheNearestOne) {
  TrackingParameters parameters;
  parameters.loop_min_gap = 3;
  parameters.loop_candidates = 1;
  LocalMap map = rowOf({9, 5, 9, 3, 4, 6, 7, 5});
  EXPECT_THAT(mostSimilar(map, map.keyframe(7).thumbnail, 7, 2), ElementsAre(1, 0)) << "ties: the lower number";
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1)) << "the others are 4 m away or more";
  map.keyframe(7).odom_from_camera.translation().x() = 2.8;
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1, 3)) << "nearest: 0.2 m; its gap is 4";
  map.keyframe(7).odom_from_camera.linear() = expSO3({0, 0.65, 0});
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1)) << "0.2 / 2 + 0.65 / 0.7 > 1";
  map.keyframe(7).odom_from_camera = map.keyframe(5).odom_from_camera;
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1)) << "too recent: 4 and 5; 3 is 2 m away";
  map.keyframe(7).odom_from_camera.translation().x() = 4.9;
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1, 3));
  map.keyframe(3).origin = 1;
  EXPECT_THAT(loopCandidates(map, 7, parameters), ElementsAre(1)) << "unrelated frames";
  parameters.loop_candidates = 0;
  EXPECT_TRUE(loopCandidates(map, 7, parameters).empty());
  parameters.loop_candidates = 2;
  parameters.loop_min_gap = 7;
  EXPECT_TRUE(loopCandidates(map, 7, parameters).empty()) << "nothing old enough";
}

}  // namespace
}  // namespace roomgraph::tracking
