// SPDX-License-Identifier: BSD-3-Clause
// One map of two sessions, against values worked out by hand.
#include <gmock/gmock.h>

#include <set>

#include "roomgraph/association/landmark_union.h"
#include "roomgraph/maptools/map_union.h"
#include "two_sessions.h"

namespace roomgraph {
namespace {

using test::objectAt;
using test::sessionMap;

CSemanticMap withGrid(float x_min, float x_max, float p_free) {
  CSemanticMap map;
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(x_min, x_max, 0.f, 1.f, 0.5f);
  map.occupancy->fill(p_free);
  return map;
}

TEST(MapUnion, CellsAddTheirLogOdds) {
  const CSemanticMap all = unitedMaps(withGrid(0, 2, 0.7f), withGrid(1, 3, 0.8f), {});
  ASSERT_TRUE(all.occupancy);
  EXPECT_EQ(all.occupancy->getSizeX(), 6u);
  EXPECT_NEAR(all.occupancy->getPos(0.25f, 0.25f), 0.7, 0.04);
  EXPECT_NEAR(all.occupancy->getPos(2.75f, 0.25f), 0.8, 0.04);
  // Odds 7/3 and 4: together 28/3.
  EXPECT_NEAR(all.occupancy->getPos(1.25f, 0.75f), 28.0 / 31, 0.04);
  const CSemanticMap opposed = unitedMaps(withGrid(0, 2, 0.7f), withGrid(0, 2, 0.3f), {});
  EXPECT_NEAR(opposed.occupancy->getPos(1.25f, 0.75f), 0.5, 0.04);
  EXPECT_NEAR(unitedMaps(withGrid(0, 2, 0.7f), withGrid(-1, 2, 0.5f), {}).occupancy->getPos(1.25f, 0.75f),
              0.7, 0.04);
}

ObjectDifference stayedPair(const Landmark& a, const Landmark& b) {
  return {ObjectChange::kStayed, a, b, 1, 1};
}

TEST(MapUnion, ObjectsAreFusedByInformation) {
  Landmark a = objectAt(1, "sofa", 1, 2, 0.2), b = objectAt(7, "sofa", 1.2, 2.3, 0.2 + 3.14159265358979);
  a.covariance = Eigen::Vector4d(0.01, 0.04, 0.01, 0.01).asDiagonal();
  b.covariance = Eigen::Vector4d(0.03, 0.02, 0.01, 0.01).asDiagonal();
  a.observations = 30;
  b.observations = 10;
  a.shape.width = 1.6;
  b.shape.width = 2;
  a.existence = 0.8;
  b.existence = 0.7;
  a.class_posterior = {{"sofa", 1}};
  b.class_posterior = {{"sofa", 0.6}, {"bed", 0.4}};
  CSemanticMap of_a, of_b;
  of_a.landmarks = {a};
  of_b.landmarks = {b};
  of_a.seen[a.id] = {10, 20};
  of_b.seen[b.id] = {30, 45};
  of_a.weights[a.id] = 20;
  of_b.weights[b.id] = 4;
  const CSemanticMap all = unitedMaps(of_a, of_b, {stayedPair(a, b)});
  ASSERT_EQ(all.landmarks.size(), 1u);
  const Landmark& one = all.landmarks[0];
  EXPECT_EQ(one.id.value, 1);
  EXPECT_NEAR(one.position.x(), 1 + 0.2 * 0.01 / 0.04, 1e-9);
  EXPECT_NEAR(one.position.y(), 2 + 0.3 * 0.04 / 0.06, 1e-9);
  EXPECT_NEAR(one.covariance(0, 0), 1 / (1 / 0.01 + 1 / 0.03), 1e-9);
  EXPECT_NEAR(one.covariance(1, 1), 1 / (1 / 0.04 + 1 / 0.02), 1e-9);
  EXPECT_NEAR(one.yaw, 0.2, 1e-6) << "half a turn apart is the same sofa";
  EXPECT_NEAR(one.shape.width, 1.7, 1e-9);
  EXPECT_NEAR(one.existence, 28.0 / 31, 1e-9) << "odds 4 and 7 / 3";
  EXPECT_NEAR(all.weights.at(one.id), 24, 1e-9);
  const auto classes = combinedClasses(a.class_posterior, 20, b.class_posterior, 4);
  EXPECT_EQ(one.class_posterior, classes) << "by the weights of the sightings, not their number";
  EXPECT_EQ(one.observations, 40);
  EXPECT_EQ(all.seen.at(one.id).first, 10);
  EXPECT_EQ(all.seen.at(one.id).last, 45);
}

// What two pieces of one recording have seen in their common time they have seen once.
TEST(MapUnion, CommonRecordsCountOnce) {
  Landmark a = objectAt(1, "sofa", 1, 2, 0.2), b = objectAt(7, "sofa", 1.2, 2, 0.2);
  a.covariance = b.covariance = 0.01 * Eigen::Matrix4d::Identity();
  a.observations = b.observations = 30;
  a.existence = b.existence = 0.8;
  CSemanticMap of_a, of_b;
  of_a.landmarks = {a};
  of_b.landmarks = {b};
  of_a.weights[a.id] = of_b.weights[b.id] = 20;
  of_a.seen[a.id] = {10, 30};
  const auto united = [&](const SeenSpan& seen_by_b, const SeenSpan& common) {
    of_b.seen[b.id] = seen_by_b;
    const CSemanticMap both = unitedMaps(of_a, of_b, {stayedPair(a, b)}, common);
    return std::pair{both.landmarks.at(0), both.weights.at(LandmarkId{1})};
  };
  const auto [none, weight_none] = united({40, 60}, {30.5, 39});
  EXPECT_NEAR(none.covariance(0, 0), 0.005, 1e-9) << "nothing in common";
  EXPECT_NEAR(none.existence, 16.0 / 17, 1e-9);
  EXPECT_NEAR(weight_none, 40, 1e-9);
  // A quarter of b's sightings are in the common time: three quarters of its information are its own.
  const auto [part, weight_part] = united({25, 45}, {25, 30});
  EXPECT_NEAR(part.covariance(0, 0), 1 / (100 + 75.0), 1e-9);
  EXPECT_NEAR(part.position.x(), 1 + 0.2 * 75 / 175, 1e-9);
  EXPECT_NEAR(part.existence, 1 - 1 / (1 + std::pow(4, 1.75)), 1e-9);
  EXPECT_NEAR(weight_part, 35, 1e-9);
  EXPECT_EQ(part.observations, 30 + 23);
  // All of b's are: it adds nothing.
  const auto [all, weight_all] = united({20, 30}, {20, 30});
  EXPECT_NEAR(all.covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(all.position.x(), 1, 1e-12);
  EXPECT_EQ(all.observations, 30);
  EXPECT_NEAR(weight_all, 20, 1e-9);
  // The other way round it is a that adds nothing.
  of_a.seen[a.id] = {20, 30};
  EXPECT_NEAR(united({20, 60}, {20, 30}).first.position.x(), 1.2, 1e-12);
}

TEST(MapUnion, CellsOfCommonRecordsCountOnce) {
  const SeenSpan common{0, 1};
  const auto p = [&](float a, float b) { return unitedMaps(withGrid(0, 2, a), withGrid(0, 2, b), {}, common).occupancy->getPos(1.25f, 0.75f); };
  EXPECT_NEAR(p(0.7f, 0.8f), 0.8, 0.04);
  EXPECT_NEAR(p(0.8f, 0.7f), 0.8, 0.04);
  EXPECT_NEAR(p(0.2f, 0.3f), 0.2, 0.04);
  EXPECT_NEAR(p(0.7f, 0.3f), 0.5, 0.04) << "they contradict each other";
  EXPECT_NEAR(p(0.5f, 0.3f), 0.3, 0.04);
}

TEST(MapUnion, AMapContinuesThoseThatItWasMadeFrom) {
  CSemanticMap monday, friday, other;
  monday.provenance.history = {"run of monday.rawlog"};
  friday.provenance.history = {"run of monday.rawlog", "continued by a run of friday.rawlog"};
  other.provenance.history = {"run of friday.rawlog", "continued by a run of friday.rawlog"};
  EXPECT_TRUE(continues(friday, monday));
  EXPECT_FALSE(continues(monday, friday));
  EXPECT_FALSE(continues(monday, monday)) << "another recording may have that name";
  EXPECT_FALSE(continues(other, monday));
  EXPECT_FALSE(continues(friday, {}));
  monday.seen[LandmarkId{3}] = {10, 20};
  friday.seen[LandmarkId{3}] = {10, 900};
  EXPECT_TRUE(continues(friday, monday));
  friday.seen[LandmarkId{3}] = {11, 900};
  EXPECT_FALSE(continues(friday, monday)) << "begun by another recording of that name";
  friday.seen[LandmarkId{3}] = {10, 900};
  friday.provenance.history.push_back("cropped");
  EXPECT_FALSE(continues(friday, monday)) << "it no longer holds all of it";
}

KeyView viewAt(double t, double x) {
  KeyView out;
  out.t = t;
  out.world_from_camera.translation().x() = x;
  return out;
}

TEST(MapUnion, OfTwoViewsOfAPlaceTheLaterOneStays) {
  CSemanticMap a, b;
  a.views = {viewAt(1, 0), viewAt(2, 5)};
  b.views = {viewAt(11, 5.1), viewAt(12, 9)};
  const auto times = [](const CSemanticMap& map) {
    std::vector<double> out;
    for (const auto& view : map.views) out.push_back(view.t);
    return out;
  };
  EXPECT_EQ(times(unitedMaps(a, b, {})), (std::vector<double>{1, 11, 12}));
  EXPECT_EQ(times(unitedMaps(b, a, {})), (std::vector<double>{1, 11, 12}));
}

TEST(MapUnion, ChangesAreApplied) {
  const CSemanticMap a = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0}, 1000);
  CSemanticMap b = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0}, 2000);
  b.landmarks[2].position += Eigen::Vector3d(-1.2, 1.1, 0);
  b.landmarks[3].id.value = 77;
  b.landmarks.erase(b.landmarks.begin());
  b.landmarks.push_back(objectAt(1, "bed", 4.6, 3.0));
  const CSemanticMap all = unitedMaps(a, b, differenceOf(a, b));
  std::set<std::int64_t> ids;
  bool bed = false;
  for (const auto& object : all.landmarks) {
    EXPECT_TRUE(ids.insert(object.id.value).second) << "an id twice";
    bed = bed || object.class_name == "bed";
    if (object.id.value == 3) {
      EXPECT_NEAR(object.position.x(), 5.3, 1e-9);
    }
  }
  EXPECT_TRUE(bed);
  EXPECT_FALSE(ids.contains(1)) << "chair 1 is gone";
  EXPECT_TRUE(ids.contains(4) && ids.contains(7)) << "known by its old name; a new one";
  EXPECT_EQ(all.landmarks.size(), 6u);
  EXPECT_EQ(all.world_from_robot.size(), 10u);
  EXPECT_EQ(all.origin, "session at 1000 + session at 2000");
  const CSemanticMap turned = unitedMaps(b, a, differenceOf(b, a));
  EXPECT_EQ(turned.world_from_robot.front().t, 1000) << "in order of time";
  const CSemanticMap same_time = unitedMaps(a, a, differenceOf(a, a));
  EXPECT_EQ(same_time.world_from_robot.size(), 5u);
  EXPECT_THAT(same_time.provenance.history.back(), ::testing::HasSubstr("overlaps in time"));
}

}  // namespace
}  // namespace roomgraph
