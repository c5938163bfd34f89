// SPDX-License-Identifier: BSD-3-Clause
// Local map: both directions of "keyframe sees point", covisibility by counting, insertion and culling of keyframes.
#include "local_map.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "keyframe_insertion.h"

namespace roomgraph::tracking {
namespace {

using ::testing::ElementsAre;

/// Keyframe at (x, 0, 0), looking along z, that sees places as features with their own descriptors.
Keyframe keyframeAt(double x, const std::vector<Eigen::Vector3d>& places, int segment = 0) {
  Keyframe out;
  out.t = x;
  out.segment = segment;
  out.camera = {640, 480, 525, 525, 320, 240, {}};
  out.odom_from_camera.translation().x() = x;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector3d p = out.odom_from_camera.inverse() * places[i];
    const Eigen::Vector2d pixel = out.camera.project(p);
    out.features.places.push_back({cv::Point2d(pixel.x(), pixel.y())});
    std::mt19937 random(static_cast<unsigned>(std::lround(3000 * places[i].x()) + std::lround(100 * places[i].y())));
    Descriptor descriptor;
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random() % 256);
    out.features.descriptors.push_back(descriptor);
    out.features.depth.push_back(static_cast<float>(p.z()));
  }
  out.features.grid = FeatureGrid(out.features.places, 640, 480);
  out.points.assign(places.size(), -1);
  return out;
}

std::vector<Eigen::Vector3d> wallOfPlaces() {
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 6; ++j) out.emplace_back(0.2 * i - 0.7, 0.2 * j - 0.5, 3);
  return out;
}

/// A keyframe's feature shows a point exactly when the point's sightings name it.
void expectConsistent(const LocalMap& map) {
  for (int k = 0; k < static_cast<int>(map.keyframes.size()); ++k)
    for (std::size_t i = 0; i < map.keyframe(k).points.size(); ++i) {
      const auto id = map.keyframe(k).points[i];
      if (id < 0) continue;
      const auto& sightings = map.point(id).sightings;
      EXPECT_EQ(std::count_if(sightings.begin(), sightings.end(),
                              [&](const Sighting& s) { return s.keyframe == k && s.feature == static_cast<int>(i); }),
                1);
    }
  for (std::size_t id = 0; id < map.points.size(); ++id)
    for (const auto& s : map.points[id].sightings)
      EXPECT_EQ(map.keyframe(s.keyframe).points[static_cast<std::size_t>(s.feature)], static_cast<std::int64_t>(id));
}

TEST(LocalMap, APointIsWhereItsFeatureAndDepthPutIt) {
  LocalMap map;
  const Eigen::Vector3d place(0.4, -0.3, 2.5);
  map.keyframes.push_back(keyframeAt(0.2, {place}));
  map.keyframe(0).features.places[0].octave = 3;
  const auto id = map.createPoint(0, 0);
  const MapPoint& point = map.point(id);
  EXPECT_LT((point.position - place).norm(), 1e-5);
  EXPECT_EQ(map.keyframe(0).points[0], id);
  EXPECT_EQ(point.octave, 3);
  EXPECT_NEAR(point.distance, Eigen::Vector3d(0.2, -0.3, 2.5).norm(), 1e-5);
  EXPECT_LT((point.direction - Eigen::Vector3d(0.2, -0.3, 2.5).normalized()).norm(), 1e-5);
  EXPECT_EQ(point.visible, 1);
  EXPECT_EQ(point.found, 1);
}

TEST(LocalMap, RemovalKeepsBothDirectionsConsistent) {
  LocalMap map;
  for (int k = 0; k < 3; ++k) map.keyframes.push_back(keyframeAt(0.1 * k, wallOfPlaces()));
  for (int i = 0; i < 10; ++i) {
    const auto id = map.createPoint(0, i);
    map.addSighting(id, 1, i);
    if (i % 2) map.addSighting(id, 2, i);
  }
  expectConsistent(map);
  map.removeSighting(3, 1);
  map.removeSighting(4, 2);  // never saw it
  expectConsistent(map);
  EXPECT_EQ(map.keyframe(1).points[3], -1);
  EXPECT_EQ(map.point(3).sightings.size(), 2u);
  EXPECT_EQ(map.point(4).sightings.size(), 2u);
  map.removeSighting(4, 0);
  EXPECT_FALSE(map.point(4).erased);
  map.removeSighting(4, 1);
  EXPECT_TRUE(map.point(4).erased) << "nobody sees it any more";
  map.erase(5);
  EXPECT_TRUE(map.point(5).erased);
  EXPECT_TRUE(map.point(5).sightings.empty());
  expectConsistent(map);
  EXPECT_THAT(map.pointsOf({2, 1}), ElementsAre(0, 1, 2, 3, 6, 7, 8, 9));
}

TEST(LocalMap, AKeyframeThatIsGivenUpLeavesThePointsThatOthersSee) {
  LocalMap map;
  for (int k = 0; k < 2; ++k) map.keyframes.push_back(keyframeAt(0.1 * k, wallOfPlaces(), 3));
  for (int i = 0; i < 10; ++i) {
    const auto id = map.createPoint(1, i);
    if (i < 4) map.addSighting(id, 0, i);
  }
  map.keyframe(1).origin = 2;
  map.giveUp(1, 0);
  expectConsistent(map);
  EXPECT_FALSE(map.keyframe(0).isGivenUp());
  const Keyframe& given_up = map.keyframe(1);
  EXPECT_TRUE(given_up.isGivenUp());
  EXPECT_EQ(given_up.shown_by, 0);
  EXPECT_EQ(given_up.features.descriptors.capacity() + given_up.points.capacity(), 0u) << "its memory is free";
  EXPECT_EQ(given_up.t, 0.1);
  EXPECT_EQ(given_up.segment, 3);
  EXPECT_EQ(given_up.origin, 2);
  EXPECT_EQ(given_up.odom_from_camera.translation().x(), 0.1);
  EXPECT_EQ(map.points.held(), 4u);
  EXPECT_THAT(map.pointsOf({0, 1}), ElementsAre(0, 1, 2, 3));
}

TEST(PointStore, ManyErasedInARowKeepTheirIdsToo) {
  PointStore points;
  constexpr std::size_t kMany = 5000, kErased = 4000;
  for (std::size_t id = 0; id < kMany; ++id) points.add().position.x() = static_cast<double>(id);
  for (std::size_t id = 0; id < kErased; ++id) points.release(id);
  points.release(7);
  EXPECT_EQ(points.held(), kMany - kErased);
  points.add().position.x() = kMany;
  EXPECT_EQ(points.size(), kMany + 1);
  for (std::size_t id = 0; id <= kMany; ++id) {
    ASSERT_EQ(points[id].erased, id < kErased) << id;
    if (id >= kErased) {
      EXPECT_EQ(points[id].position.x(), static_cast<double>(id));
    }
  }
}

TEST(PointStore, AnErasedPointLeavesItsMemoryToOthersAndKeepsItsId) {
  PointStore points;
  std::map<std::size_t, double> alive;  // x of the position
  std::size_t made = 0, most = 0;
  std::mt19937 random(11);
  for (int step = 0; step < 5000; ++step) {
    if (alive.empty() || random() % 100 < (step < 1000 ? 80 : 50)) {
      MapPoint& point = points.add();
      EXPECT_FALSE(point.erased);
      EXPECT_TRUE(point.sightings.empty() && point.visible == 0) << "of the one before nothing is left";
      point.position.x() = alive[made++] = static_cast<double>(random() % 1000);
      point.visible = 3;
      point.sightings.push_back({1, 2});
    } else {
      const auto victim = std::next(alive.begin(), static_cast<std::ptrdiff_t>(random() % alive.size()));
      points.release(victim->first);
      points.release(victim->first);  // again: nothing happens
      alive.erase(victim);
    }
    most = std::max(most, alive.size());
    ASSERT_EQ(points.size(), made);
    ASSERT_EQ(points.held(), alive.size());
  }
  EXPECT_LT(most, made / 2);
  for (std::size_t id = 0; id < made; ++id) {
    const auto found = alive.find(id);
    ASSERT_EQ(points[id].erased, found == alive.end()) << id;
    if (found != alive.end()) {
      EXPECT_EQ(points[id].position.x(), found->second) << id;
    } else {
      EXPECT_TRUE(points[id].sightings.empty()) << id;
    }
  }
}

TEST(LocalMap, CovisibilityCountsSharedPoints) {
  std::mt19937 random(3);
  LocalMap map;
  for (int k = 0; k < 5; ++k) map.keyframes.push_back(keyframeAt(0.1 * k, wallOfPlaces()));
  std::vector<std::set<int>> seen_by;
  for (int i = 0; i < 48; ++i) {
    const auto id = map.createPoint(0, i);
    seen_by.push_back({0});
    for (int k = 1; k < 5; ++k)
      if (static_cast<int>(random() % 5) < k) {
        map.addSighting(id, k, i);
        seen_by.back().insert(k);
      }
  }
  const std::vector<std::int64_t> asked{1, -1, 5, 6, 7, 8, 20, 33, 40};
  const auto shared = map.covisible(asked);
  std::set<int> listed, expected;
  for (const auto id : asked)
    if (id >= 0) expected.insert(seen_by[static_cast<std::size_t>(id)].begin(), seen_by[static_cast<std::size_t>(id)].end());
  for (std::size_t j = 0; j < shared.size(); ++j) {
    int count = 0;
    for (const auto id : asked) count += id >= 0 && seen_by[static_cast<std::size_t>(id)].contains(shared[j].second);
    EXPECT_EQ(shared[j].first, count);
    if (j > 0) {
      EXPECT_GE(shared[j - 1].first, shared[j].first);
    }
    listed.insert(shared[j].second);
  }
  EXPECT_EQ(listed, expected);
}

TEST(KeyframeInsertion, NewFeaturesBecomePointsThatNeighboursAreAskedFor) {
  TrackingParameters parameters;
  const auto places = wallOfPlaces();
  LocalMap map;
  Keyframe first = keyframeAt(0, places);
  insertKeyframe(map, first, parameters);
  ASSERT_EQ(map.points.size(), places.size());
  // Of the second one's features the first half is tracked; eight lost their point in the first keyframe.
  for (std::int64_t id = 40; id < 48; ++id) map.erase(id);
  Keyframe second = keyframeAt(0.3, places);
  for (std::size_t i = 0; i < 40; ++i) second.points[i] = static_cast<std::int64_t>(i);
  second.features.depth[47] = 0;
  EXPECT_EQ(insertKeyframe(map, second, parameters), 1);
  expectConsistent(map);
  EXPECT_EQ(map.points.size(), 48u + 7) << "47 has no depth";
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(map.keyframe(1).points[i], static_cast<std::int64_t>(i));
  EXPECT_EQ(map.keyframe(1).points[47], -1);
  for (std::size_t i = 40; i < 47; ++i) {
    // The first keyframe shows it, too, at the same feature: found again by projection and descriptor.
    const auto id = map.keyframe(1).points[i];
    EXPECT_GE(id, 48);
    EXPECT_EQ(map.keyframe(0).points[i], id);
  }
}

TEST(KeyframeInsertion, PointsThatNobodySeesAgainAreCulled) {
  TrackingParameters parameters;
  const auto places = wallOfPlaces();
  LocalMap map;
  insertKeyframe(map, keyframeAt(0, places), parameters);
  map.point(5).visible = 9;  // found once in nine frames that should have seen it
  const auto later = [&](double x, int segment) {
    Keyframe keyframe = keyframeAt(x, places, segment);
    for (std::int64_t id = 0; id < 20; ++id)
      keyframe.points[static_cast<std::size_t>(id)] = map.point(id).erased ? -1 : id;
    keyframe.features.depth.assign(places.size(), 0.F);
    return insertKeyframe(map, keyframe, parameters);
  };
  later(0.1, 0);
  EXPECT_TRUE(map.point(5).erased);
  EXPECT_FALSE(map.point(30).erased) << "still on probation";
  later(0.2, 0);
  EXPECT_TRUE(map.point(30).erased) << "seen once in three keyframes";
  EXPECT_FALSE(map.point(10).erased);
  expectConsistent(map);
}

TEST(KeyframeInsertion, AnotherSegmentIsLeftAlone) {
  TrackingParameters parameters;
  const auto places = wallOfPlaces();
  LocalMap map;
  insertKeyframe(map, keyframeAt(0, places), parameters);
  for (int k = 1; k < 4; ++k) insertKeyframe(map, keyframeAt(0.1 * k, places, 1), parameters);
  for (std::int64_t id = 0; id < 48; ++id) EXPECT_FALSE(map.point(id).erased) << id;
}

// What a point looks like is what the latest of its sightings saw; those that are removed are forgotten.
TEST(LocalMap, APointLooksAsTheLatestSightingThatItHas) {
  LocalMap map;
  for (int k = 0; k < 3; ++k) {
    map.keyframes.push_back(keyframeAt(0.5 * k, {{0, 0, 3}}));
    map.keyframe(k).features.descriptors[0].fill(static_cast<std::uint8_t>(k));
  }
  const auto id = map.createPoint(0, 0);
  map.addSighting(id, 1, 0);
  map.addSighting(id, 2, 0);
  const auto expectSeenFrom = [&](int k) {
    EXPECT_EQ(map.point(id).descriptor[0], k);
    EXPECT_NEAR(map.point(id).distance, std::hypot(0.5 * k, 3), 1e-9);
    EXPECT_NEAR(map.point(id).direction.x(), -0.5 * k / std::hypot(0.5 * k, 3), 1e-9);
  };
  expectSeenFrom(2);
  map.removeSighting(id, 0);
  expectSeenFrom(2);
  map.removeSighting(id, 2);
  expectSeenFrom(1);
  expectConsistent(map);
}

}  // namespace
}  // namespace roomgraph::tracking
