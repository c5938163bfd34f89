// SPDX-License-Identifier: BSD-3-Clause
// ObjectMapper: sightings that repeat others are given up, and what is known of them still.
#include <gtest/gtest.h>

#include <set>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/estimation/object_mapper.h"
#include "shipped_objects.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

constexpr int kFrames = 121;
constexpr std::size_t kLooked = 50, kLeft = 40;  // frames from which on they are looked through; that are left of one landmark's

ObjectMeasurement sofaAt(const Frame& frame, double x, double y, double score = 0.9) {
  ObjectMeasurement out;
  out.frame = frame.id;
  out.t = frame.t;
  out.proposal.class_name = out.proposal.model = "sofa";
  out.proposal.shape = {ShapeKind::kCuboid, 1.8, 0.9, 0.8};
  out.proposal.camera_from_object = frame.robot_from_camera.inverse() * poseFromYpr(x, y, 0, 0, 0, 0);
  out.proposal.covariance = 0.01 * Eigen::Matrix4d::Identity();
  out.proposal.score = score;
  out.detection.class_name = "sofa";
  out.detection.score = 0.9;
  out.detection.box = {100, 100, 200 + static_cast<double>(frame.id.value), 200};
  return out;
}

std::shared_ptr<Associator> associator(const char* name, const char* options = "") {
  association::registerClasses();
  std::shared_ptr<Associator> out = createStage<Associator>(name, "test");
  Config::fromText(options, "test").read("association", *out);
  return out;
}

class FormerSightings : public ::testing::Test {
 protected:
  FormerSightings() {
    for (int i = 0; i < kFrames; ++i) poses_.add(i, Pose3::Identity());
  }
  // A sofa that is seen in every frame at the place, by turns where there are two.
  void see(ObjectMapper& mapper, double aside_m = 0) {
    for (int i = 0; i < kFrames; ++i) {
      const Frame frame = frameAt(i, i);
      mapper.associate({sofaAt(frame, 3, i % 2 ? aside_m : -aside_m)}, frame, {}, noDrift());
      if (i % 3 == 2) mapper.missUnseen({}, {}, frame);  // the detector looked again, and found nothing
    }
  }
  KeyPoses poses_{standing()};
};

TEST_F(FormerSightings, FewAreKeptOfOneViewAndOfOthersItIsKnownWhoIsWho) {
  ObjectMapper mapper(associator("SoftAssociator"), {}, 0.03, poses_);
  see(mapper);
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
  const Landmark before = mapper.landmarks().landmarks()[0];
  mapper.giveUpRepeated(kFrames, poses_.trajectory());
  EXPECT_EQ(mapper.frames().size(), static_cast<std::size_t>(kFrames));  // not more than are kept in any case
  EXPECT_TRUE(mapper.frames().former().empty());
  mapper.giveUpRepeated(kLooked, poses_.trajectory());
  EXPECT_EQ(mapper.frames().size(), kLeft);
  EXPECT_EQ(mapper.frames()[0].t, 0);
  EXPECT_EQ(mapper.frames().back().t, kFrames - 1);
  const auto& former = mapper.frames().former();
  ASSERT_EQ(former.size(), kFrames - kLeft);
  std::set<double> times;
  for (const FormerSighting& sighting : former) {
    times.insert(sighting.t);
    EXPECT_EQ(sighting.landmark, before.id);
    EXPECT_EQ(sighting.class_name, "sofa");
    EXPECT_EQ(static_cast<double>(sighting.frame.value), sighting.t);
    EXPECT_EQ(sighting.box.u_max, 200 + sighting.t);
    EXPECT_LT((sighting.place_in_robot - Eigen::Vector3d(3, 0, 0)).norm(), 1e-9);
    EXPECT_GT(sighting.probability, 0.5);
  }
  EXPECT_EQ(times.size(), former.size());
  for (const auto& frame : mapper.frames()) EXPECT_FALSE(times.contains(frame.t));
  EXPECT_EQ(mapper.landmarks().landmarks()[0].position, before.position);  // fused is fused
}

// With hindsight existence is reckoned again: misses are all remembered, so must the sightings be.
TEST_F(FormerSightings, ExistenceAndSpansStayThroughReassociation) {
  const auto after = [&](bool given_up) {
    ObjectMapper mapper(associator("SoftAssociator"), {}, 0.03, poses_);
    see(mapper);
    if (given_up) mapper.giveUpRepeated(kLooked, poses_.trajectory());
    EXPECT_TRUE(mapper.reassociate());
    EXPECT_EQ(mapper.landmarks().landmarks().size(), 1u);
    const LandmarkId id = mapper.landmarks().landmarks().at(0).id;
    EXPECT_EQ(mapper.seenSpans().at(id).first, 0);
    EXPECT_EQ(mapper.seenSpans().at(id).last, kFrames - 1);
    return mapper.landmarks().landmarks().at(0).existence;
  };
  const double all = after(false), some = after(true);
  const auto logOdds = [](double p) { return std::log(p / (1 - p)); };
  EXPECT_GT(logOdds(all), 1);
  EXPECT_NEAR(logOdds(some), logOdds(all), 0.5);
}

// Poses and landmarks move, as when the run is recognised in an earlier map: what was seen before is where the landmark is.
TEST_F(FormerSightings, AreJudgedByThePosesOfNow) {
  ObjectMapper mapper(associator("SoftAssociator"), {}, 0.03, poses_);
  see(mapper);
  const Pose3 moved = poseFromYpr(5, -3, 0, 2, 0, 0);
  for (int i = 0; i < kFrames; ++i) poses_.set(NodeId{i}, moved);
  mapper.move({0, moved});
  mapper.giveUpRepeated(kLooked, poses_.trajectory());
  ASSERT_EQ(mapper.frames().former().size(), kFrames - kLeft);
  for (const FormerSighting& sighting : mapper.frames().former()) EXPECT_GT(sighting.existence_log_ratio, 0.1);
}

// Of the last moments nothing is given up, and of two landmarks each keeps its forty.
TEST_F(FormerSightings, WhatIsNewOrSeldomStays) {
  ObjectMapper mapper(associator("NearestNeighborAssociator"), {}, 0.03, poses_);
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = frameAt(i, i);
    std::vector<ObjectMeasurement> seen{sofaAt(frame, 3, 0)};
    if (i % 3 == 0) seen.push_back(sofaAt(frame, 6, 3));
    mapper.associate(seen, frame, {}, noDrift());
  }
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 2u);
  Trajectory until_lately;
  for (int i = 0; i <= 80; ++i) until_lately.add(i, Pose3::Identity());
  mapper.giveUpRepeated(kLooked, until_lately);
  std::map<LandmarkId, int> kept;
  for (const auto& frame : mapper.frames())
    for (const auto& decision : frame.decisions) ++kept[decision.landmark];
  for (const auto& [landmark, sightings] : kept) EXPECT_GE(sightings, 40);
  ASSERT_FALSE(mapper.frames().former().empty());
  EXPECT_LE(mapper.frames().former().back().t, 80);
}

// Landmarks whose sightings are given up become one, and take the id of an earlier map.
TEST_F(FormerSightings, FollowTheirLandmarkWhenItIsMergedOrRenamed) {
  ObjectMapper mapper(associator("SoftAssociator"), {}, 0.03, poses_);
  mapper.reserveIds(LandmarkId{70});
  see(mapper);
  mapper.giveUpRepeated(kLooked, poses_.trajectory());
  Landmark earlier = mapper.landmarks().landmarks().at(0);
  earlier.id = LandmarkId{7};
  mapper.continueIds({earlier});
  for (const FormerSighting& sighting : mapper.frames().former()) EXPECT_EQ(sighting.landmark, earlier.id);
  EXPECT_EQ(mapper.seenSpans().size(), 1u);
}

TEST_F(FormerSightings, WhenALandmarkIsSplitTheyAre) {
  ObjectMapper mapper(associator("NearestNeighborAssociator", "[association]\nmax_distance_ratio = 5\n"), {}, 0.03, poses_);
  see(mapper, 0.9);
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
  mapper.giveUpRepeated(kLooked, poses_.trajectory());
  mapper.tidy();
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 2u);
  std::set<LandmarkId> left, right;
  for (const FormerSighting& sighting : mapper.frames().former())
    (sighting.frame.value % 2 ? left : right).insert(sighting.landmark);
  ASSERT_EQ(left.size(), 1u);
  ASSERT_EQ(right.size(), 1u);
  EXPECT_NE(*left.begin(), *right.begin());
  EXPECT_NEAR(mapper.landmarks().find(*left.begin())->position.y(), 0.9, 0.1);
}

}  // namespace
}  // namespace roomgraph::test
