// SPDX-License-Identifier: BSD-3-Clause
// What changed between two maps, and with what probability.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "change_evidence.h"
#include "roomgraph/maptools/map_difference.h"
#include "two_sessions.h"

namespace roomgraph {
namespace {

using test::objectAt;
using test::sessionMap;

const ObjectDifference& of(const std::vector<ObjectDifference>& all, int before, int after) {
  for (const auto& one : all)
    if ((one.before ? one.before->id.value : -1) == before && (one.after ? one.after->id.value : -1) == after)
      return one;
  static const ObjectDifference none;
  ADD_FAILURE() << "no " << before << " -> " << after;
  return none;
}

// A column that the lidar meets in the middle of an object.
void addColumn(CSemanticMap& map, double x, double y) {
  for (const double dx : {-0.03, 0.03})
    for (const double dy : {-0.03, 0.03})
      map.occupancy->setPos(static_cast<float>(x + dx), static_cast<float>(y + dy), 0.02f);
}

class MapDifference : public ::testing::Test {
 protected:
  CSemanticMap before = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0}),
               after = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0});
};

TEST_F(MapDifference, NothingChanged) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.04);
  for (auto& object : after.landmarks) object.position += Eigen::Vector3d(noise(random), noise(random), 0);
  std::reverse(after.landmarks.begin(), after.landmarks.end());
  const auto all = differenceOf(before, after);
  ASSERT_EQ(all.size(), 6u);
  for (int id = 1; id <= 6; ++id) {
    EXPECT_EQ(of(all, id, id).change, ObjectChange::kStayed) << id;
    EXPECT_GT(of(all, id, id).probability, 0.9);
  }
}

TEST_F(MapDifference, MovedVanishedAppeared) {
  after.landmarks[2].position += Eigen::Vector3d(-1.2, 1.1, 0);  // chair 3
  after.landmarks.erase(after.landmarks.begin() + 4);            // sofa 5
  after.landmarks.push_back(objectAt(20, "sofa", 4.1, 4.4));
  const auto all = differenceOf(before, after);
  EXPECT_EQ(of(all, 3, 3).change, ObjectChange::kMoved);
  EXPECT_GT(of(all, 3, 3).probability, 0.5);
  EXPECT_EQ(of(all, 5, 20).change, ObjectChange::kMoved) << "of one class and size: the same sofa, rather";
  after.landmarks.back().shape = {ShapeKind::kCuboid, 0.9, 0.5, 0.4};
  const auto other = differenceOf(before, after);
  EXPECT_EQ(of(other, 5, -1).change, ObjectChange::kVanished);
  EXPECT_EQ(of(other, -1, 20).change, ObjectChange::kAppeared);
  after.landmarks.back() = objectAt(20, "door", 4.1, 4.4);
  EXPECT_EQ(of(differenceOf(before, after), -1, 20).change, ObjectChange::kAppeared);
}

TEST_F(MapDifference, ThePlaceMustHaveBeenSeen) {
  const auto hidden = [](const Eigen::Vector2d& p) { return p.x() > 5.6; };
  after = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0}, 2000, hidden);
  after.landmarks.erase(after.landmarks.begin() + 2);  // chair 3 at (6.5, 1.2)
  after.landmarks.erase(after.landmarks.begin());      // chair 1 at (1, 1)
  const auto all = differenceOf(before, after);
  EXPECT_EQ(of(all, 3, -1).change, ObjectChange::kUnsure);
  EXPECT_EQ(of(all, 3, -1).seen, 0);
  EXPECT_NEAR(of(all, 3, -1).probability, 0.95 * 0.15, 1e-9) << "what was thought beforehand";
  EXPECT_EQ(of(all, 1, -1).change, ObjectChange::kVanished);
  EXPECT_NEAR(of(all, 1, -1).seen, 1, 0.03);
  EXPECT_EQ(of(differenceOf(after, before), -1, 3).change, ObjectChange::kUnsure);
}

TEST_F(MapDifference, WhatTheLidarMetSpeaks) {
  addColumn(before, 1, 1);
  after.landmarks.erase(after.landmarks.begin());
  const double gone = of(differenceOf(before, after), 1, -1).probability;
  EXPECT_GT(gone, 0.85);
  addColumn(after, 1, 1);
  const auto there = of(differenceOf(before, after), 1, -1);
  EXPECT_LT(there.probability, 0.2);
  EXPECT_EQ(there.change, ObjectChange::kUnsure);
}

TEST_F(MapDifference, DoubtfulObjectsAreNoChange) {
  after.landmarks.erase(after.landmarks.begin());
  before.landmarks[0].existence = 0.5;
  const auto doubtful = of(differenceOf(before, after), 1, -1);
  EXPECT_EQ(doubtful.change, ObjectChange::kUnsure);
  before.landmarks[0].existence = 1;
  EXPECT_NEAR(of(differenceOf(before, after), 1, -1).probability, 2 * doubtful.probability, 1e-9);
}

TEST_F(MapDifference, CovarianceDecidesWhatIsADistance) {
  after.landmarks[0].position.x() += 0.6;
  EXPECT_EQ(of(differenceOf(before, after), 1, 1).change, ObjectChange::kMoved);
  after.landmarks[0].covariance *= 100;  // 0.3 m
  EXPECT_EQ(of(differenceOf(before, after), 1, 1).change, ObjectChange::kStayed);
}

TEST_F(MapDifference, TurnedAroundInPlaceIsAChangeHalfATurnIsNot) {
  after.landmarks[4].yaw += 1.4;
  EXPECT_EQ(of(differenceOf(before, after), 5, 5).change, ObjectChange::kMoved);
  const double turned = of(differenceOf(before, after), 5, 5).probability;
  after.landmarks[4].yaw = before.landmarks[4].yaw + 3.14;
  const auto half = of(differenceOf(before, after), 5, 5);
  EXPECT_EQ(half.change, ObjectChange::kStayed);
  EXPECT_GT(half.probability, turned);
}

// Worlds drawn from the model, those kept in which the object is not in the map: how often it was gone.
TEST(ChangeEvidence, IsTheShareAmongDrawnWorlds) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double seen : {0.0, 0.5, 1.0}) {
    int kept = 0, gone = 0;
    for (int i = 0; i < 60000; ++i) {
      const bool changed = uniform(random) < 0.15;
      const bool mapped = !changed && uniform(random) < seen && uniform(random) < 0.85;
      kept += !mapped;
      gone += changed && !mapped;
    }
    PlaceEvidence place;
    place.seen = seen;
    EXPECT_NEAR(place.probabilityOfChange(0.15, 0.85), static_cast<double>(gone) / kept, 0.01) << seen;
  }
}

TEST_F(MapDifference, JsonAndDrawingShowAll) {
  after.landmarks[2].position += Eigen::Vector3d(-1.2, 1.1, 0);
  after.landmarks.erase(after.landmarks.begin());
  const auto all = differenceOf(before, after);
  const auto json = nlohmann::json::parse(differenceJson(all));
  ASSERT_EQ(json["objects"].size(), 6u);
  EXPECT_EQ(json["objects"][0]["change"], "vanished");
  EXPECT_TRUE(json["objects"][0]["after"].is_null());
  EXPECT_EQ(json["objects"][2]["change"], "moved");
  EXPECT_NEAR(json["objects"][2]["after"]["x"].get<double>(), 5.3, 1e-9);
  const std::string svg = differenceSvg(before, after, all);
  for (const char* words :
       {"swivel_chair vanished 0.", "swivel_chair moved 0.", ">sofa<", "stroke-dasharray"})
    EXPECT_THAT(svg, ::testing::HasSubstr(words));
}

}  // namespace
}  // namespace roomgraph
