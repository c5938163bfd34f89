// SPDX-License-Identifier: BSD-3-Clause
// ObjectMapper: sightings follow a landmark that is split in two.
#include "roomgraph/estimation/object_mapper.h"

#include <gtest/gtest.h>

#include <set>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "shipped_objects.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

ObjectMeasurement chairAt(const Frame& frame, double x, double y) {
  ObjectMeasurement out;
  out.frame = frame.id;
  out.t = frame.t;
  out.proposal.class_name = out.proposal.model = "swivel_chair";
  out.proposal.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  out.proposal.camera_from_object = frame.robot_from_camera.inverse() * poseFromYpr(x, y, 0, 0, 0, 0);
  out.proposal.covariance = 0.01 * Eigen::Matrix4d::Identity();
  out.proposal.score = 0.9;
  out.detection.class_name = "swivel_chair";
  out.detection.score = 0.9;
  return out;
}

std::shared_ptr<Associator> generousAssociator() {
  association::registerClasses();
  std::shared_ptr<Associator> out = createStage<Associator>("NearestNeighborAssociator", "test");
  Config::fromText("[association]\nmax_distance_ratio = 5\n", "test").read("association", *out);
  return out;
}

// For another thread: what comes afterwards is not in it.
TEST(ObjectMapper, FactorsOfACopyAreThoseOfTheTimeWhenItWasMade) {
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  ObjectMapper mapper(generousAssociator(), {}, 0.03, poses);
  const ObjectDatabase& database = shippedObjects();
  const BackendOptions options;
  const auto see = [&](int i) { mapper.associate({chairAt(frameAt(i, 0.5 * i), 3, 0.1 * i)}, frameAt(i, 0.5 * i), {}, noDrift()); };
  for (int i = 0; i < 3; ++i) see(i);
  const ObjectsAtPoses later = mapper.inGraphLater(database, options);
  const ObjectsInGraph now = mapper.inGraph(database, options);
  ASSERT_EQ(now.landmarks.size(), 1u);
  ASSERT_FALSE(now.factors.sightings.empty());
  for (int i = 3; i < 9; ++i) see(i);
  const ObjectsInGraph copied = later(poses);
  ASSERT_EQ(copied.landmarks.size(), 1u);
  EXPECT_EQ(copied.landmarks[0].position, now.landmarks[0].position);
  ASSERT_EQ(copied.factors.sightings.size(), now.factors.sightings.size());
  EXPECT_EQ(copied.factors.sightings[0].position_in_robot, now.factors.sightings[0].position_in_robot);
  EXPECT_EQ(copied.factors.sightings[0].weight, now.factors.sightings[0].weight);
  EXPECT_NE(mapper.inGraph(database, options).factors.sightings[0].position_in_robot, now.factors.sightings[0].position_in_robot);
}

// Two chairs .8 m apart, in view one at a time; the associator takes them for one.
TEST(ObjectMapper, WhenALandmarkIsSplitItsSightingsAre) {
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  ObjectMapper mapper(generousAssociator(), {}, 0.03, poses);
  for (int i = 0; i < 20; ++i) {
    const Frame frame = frameAt(i, 0.5 * i);
    const auto decisions = mapper.associate({chairAt(frame, 3, i % 2 ? 0.4 : -0.4)}, frame, {}, noDrift());
    ASSERT_EQ(decisions.size(), 1u);
  }
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
  const SeenSpan both = mapper.seenSpans().begin()->second;
  EXPECT_EQ(both.first, 0);
  EXPECT_EQ(both.last, 9.5);
  // The world moves: what was remembered of it then must move along.
  const Pose3 moved = poseFromYpr(5, -3, 0, 2, 0, 0);
  poses.set(NodeId{0}, moved);
  mapper.move({0, moved});
  mapper.tidy();
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 2u);
  std::set<LandmarkId> left, right;
  for (const auto& frame : mapper.frames())
    (frame.frame.value % 2 ? left : right).insert(frame.decisions.at(0).landmark);
  ASSERT_EQ(left.size(), 1u);
  ASSERT_EQ(right.size(), 1u);
  const auto seenAt = [&](const std::set<LandmarkId>& ids) {
    return (moved.inverse() * mapper.landmarks().find(*ids.begin())->position).y();
  };
  EXPECT_NEAR(seenAt(left), 0.4, 0.05);
  EXPECT_NEAR(seenAt(right), -0.4, 0.05);
  ASSERT_EQ(mapper.seenSpans().size(), 2u);
  const SeenSpan at_left = mapper.seenSpans().at(*left.begin()),
                 at_right = mapper.seenSpans().at(*right.begin());
  EXPECT_EQ(at_left.first, 0.5);
  EXPECT_EQ(at_left.last, 9.5);
  EXPECT_EQ(at_right.first, 0);
  EXPECT_EQ(at_right.last, 9);
}

// A chair is seen again one metre beside its place: another one, unless nothing measured how the robot moved
// in between.
TEST(ObjectMapper, AfterALostCameraTheGateIsWide) {
  association::registerClasses();
  for (const bool lost : {false, true}) {
    KeyPoses poses(standing());
    Drift drift(standing(), false);
    ObjectMapper mapper(createStage<Associator>("SoftAssociator", "test"), {}, 0.03, poses);
    poses.add(0, Pose3::Identity());
    drift.extend(poses);
    for (int i = 0; i < 8; ++i) {
      const Frame frame = frameAt(i, 0.01 * i);
      mapper.associate({chairAt(frame, 1.2, 0)}, frame, {}, drift);
    }
    if (lost) {
      poses.add(0.3, Pose3::Identity());
      drift.extend(poses);
    }
    const Frame frame = frameAt(8, 0.3);
    const auto decisions = mapper.associate({chairAt(frame, 1.2, 1)}, frame, {}, drift);
    EXPECT_EQ(mapper.landmarks().landmarks().size(), lost ? 1u : 2u);
    EXPECT_NEAR(mapper.landmarks().landmarks()[0].position.y(), 0, lost ? 0.05 : 1e-9)
        << "a sighting from an unsure pose hardly moves the landmark";
    EXPECT_EQ(decisions.at(0).landmark == mapper.landmarks().landmarks()[0].id, lost);
  }
}

// Of the features of a frame, those with depth on an object are kept for the graph.
TEST(ObjectMapper, RemembersFeaturesThatLieOnObjects) {
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  ObjectMapper mapper(generousAssociator(), {}, 0.03, poses);
  const Frame frame = frameAt(0, 0);
  ObjectMeasurement chair = chairAt(frame, 3, 0);
  chair.features = {5, 7};
  mapper.associate({chair}, frame, {{{10, 10}, 5, 3.0}, {{20, 10}, 6, 3.0}, {{30, 10}, 7, 0}}, noDrift());
  ASSERT_EQ(mapper.frames().size(), 1u);
  ASSERT_EQ(mapper.frames()[0].features.size(), 1u);
  EXPECT_EQ(mapper.frames()[0].features[0].point, 5);
}

// What a thread was given stays what it was.
TEST(ObjectFrames, CopiesShareWhatIsNotChanged) {
  ObjectFrames frames(std::vector<ObjectFrame>(2)), copy = frames;
  EXPECT_EQ(&copy[0], &frames[0]);
  frames.change(1).t = 5;
  EXPECT_EQ(frames[1].t, 5);
  EXPECT_EQ(copy[1].t, 0);
  EXPECT_EQ(&copy[0], &frames[0]);
  const ObjectFrame* own = &frames[1];
  frames.change(1).t = 6;
  EXPECT_EQ(&frames[1], own) << "nobody else has it";
}

}  // namespace

// Makes two landmarks of the first two measurements and is of two minds about the third.
class Undecided : public Associator {
  DEFINE_MRPT_OBJECT(Undecided, roomgraph::test)
 public:
  std::vector<Association> associate(const std::vector<WorldMeasurement>&,
                                     const std::vector<Landmark>& landmarks) override {
    Association out;
    if (landmarks.size() == 2) {
      out.landmark = landmarks[0].id;
      out.probability = 0.5;
      out.posterior = {{landmarks[0].id, 0.5}, {landmarks[1].id, 0.3}, {LandmarkId{}, 0.2}};
    }
    return {out};
  }
};
IMPLEMENTS_MRPT_OBJECT(Undecided, roomgraph::Associator, roomgraph::test)

namespace {

// Two landmarks .2 m apart are one chair: what was said of the one is said of the other.
TEST(ObjectMapper, MergedLandmarksShareTheirPosterior) {
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  ObjectMapper mapper(std::make_shared<Undecided>(), {}, 0.03, poses);
  for (int i = 0; i < 3; ++i) {
    const Frame frame = frameAt(i, 0.5 * i);
    mapper.associate({chairAt(frame, 3, i == 0 ? 0.1 : -0.1)}, frame, {}, noDrift());
  }
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 2u);
  EXPECT_EQ(mapper.whoIsWho(), (Partition{0, 1, 0}));
  mapper.tidy();
  EXPECT_EQ(mapper.whoIsWho(), (Partition{0, 0, 0}));
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
  const LandmarkId kept = mapper.landmarks().landmarks()[0].id;
  double share = 0, all = 0;
  for (const auto& [id, probability] : mapper.frames()[2].decisions[0].association.posterior) {
    share += id == kept ? probability : 0;
    all += probability;
  }
  EXPECT_NEAR(share, 0.8, 1e-12);
  EXPECT_NEAR(all, 1, 1e-12);
  for (const auto& frame : mapper.frames()) EXPECT_EQ(frame.decisions[0].landmark, kept);
}

TEST(ObjectMapper, WhoIsWhoCountsObjectsAsTheyAppear) {
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  association::registerClasses();
  ObjectMapper mapper(createStage<Associator>("NearestNeighborAssociator", "test"), {}, 0.03, poses);
  EXPECT_TRUE(mapper.whoIsWho().empty());
  const double places[] = {1.5, -1.5, 1.5, 0, -1.5};
  for (int i = 0; i < 5; ++i) {
    const Frame frame = frameAt(i, 0.5 * i);
    mapper.associate({chairAt(frame, 3, places[i])}, frame, {}, noDrift());
  }
  const Partition seen{0, 1, 0, 2, 1};
  EXPECT_EQ(mapper.whoIsWho(), seen);
  ASSERT_TRUE(mapper.reassociate());
  EXPECT_EQ(mapper.whoIsWho(), seen);
}

// A sofa goes on from where the graph had it, as it may turn on the way from where its sightings are fused
// to; a chair begins there, and what it had been taken for does not hold it back.
TEST(ObjectMapper, WhatCanTurnGoesOnFromTheOptimum) {
  for (const ShapeKind kind : {ShapeKind::kCuboid, ShapeKind::kCylinder}) {
    KeyPoses poses(standing());
    poses.add(0, Pose3::Identity());
    association::registerClasses();
    ObjectMapper mapper(createStage<Associator>("NearestNeighborAssociator", "test"), {}, 0.03, poses);
    for (int i = 0; i < 4; ++i) {
      const Frame frame = frameAt(i, 0.5 * i);
      ObjectMeasurement seen = chairAt(frame, 3, 0.5);
      seen.proposal.shape.kind = kind;
      mapper.associate({seen}, frame, {}, noDrift());
    }
    ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
    const LandmarkId id = mapper.landmarks().landmarks()[0].id;
    const Eigen::Vector3d fused = mapper.landmarks().landmarks()[0].position;
    const LandmarkEstimate optimum{{3.05, 0.55, 0}, 0, {kind, 0.5, 0.5, 0.8}};
    mapper.apply({{id, optimum}});
    ASSERT_TRUE(mapper.reassociate());
    const Landmark* landmark = mapper.landmarks().find(id);
    ASSERT_TRUE(landmark);
    if (kind == ShapeKind::kCuboid) {
      EXPECT_EQ(landmark->position, optimum.position);
      EXPECT_EQ(landmark->shape.height, 0.8);
    } else {
      EXPECT_LT((landmark->position - fused).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace roomgraph::test
