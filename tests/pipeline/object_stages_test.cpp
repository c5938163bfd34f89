// SPDX-License-Identifier: BSD-3-Clause
// SemanticSlam with true object stages: mapping, levelling, loop closing and earlier maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "drive.h"
#include "fake_stages.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

// The fakes' scans and images show a room without its objects, so that rays speak against all of them.
const std::string kFakeObjects =
    "[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n[existence]\nenabled = false\n";

class ObjectStagesTest : public ::testing::Test {
 protected:
  ObjectStagesTest() {
    registerAllClasses();
    fakes::registerClasses();
    fakes::world() = {};
    fakes::world().world_from_camera = [](double t) {
      return toPose3(Drive::truth(t)) * Drive::robotFromCamera();
    };
  }
  static void place(const std::string& class_name, const ObjectShape& shape, double x, double y, double yaw) {
    fakes::world().objects.push_back({class_name, shape, poseFromYpr(x, y, 0, yaw, 0, 0)});
  }
  static void furnish() {
    const ObjectShape chair{ShapeKind::kCylinder, 0.6, 0.6, 0.9}, sofa{ShapeKind::kCuboid, 1.8, 0.9, 0.8};
    place("swivel_chair", chair, 3.0, -0.5, 0);
    place("swivel_chair", chair, 3.4, 2.0, 0);
    place("sofa", sofa, 1.0, 4.5, -1.5);
    place("swivel_chair", chair, -2.0, 4.0, 0);
    place("sofa", sofa, -3.2, 1.0, 0.2);
    place("swivel_chair", chair, -1.5, -2.4, 0);
  }
  static SlamResult drive(SemanticSlam& slam) {
    Drive world;
    for (int i = 0; i <= 120; ++i) {
      slam.process(world.odometry(0.1 * i));
      slam.process(world.scan(0.1 * i));
      if (i % 2 == 0) slam.process(Drive::frame(0.1 * i));
    }
    return slam.finish();
  }
};

TEST_F(ObjectStagesTest, StagesGiveUpWhatTheyRememberOnceNothingMoreIsAsked) {
  furnish();
  SemanticSlam slam(setupWith(kFakeObjects + "[tracking]\nclass = FakeOdometry\n[object_loop_closing]\nenabled = true\n"));
  drive(slam);
  EXPECT_EQ(fakes::world().releases, 1);
  EXPECT_FALSE(fakes::world().asked_after_release);
  EXPECT_THROW(slam.process(Drive::frame(20)), std::logic_error);
}

TEST_F(ObjectStagesTest, ObjectsOfExchangedStagesAreMappedWhereTheyStand) {
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
  place("swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, 0.5, 2.9, 0);
  place("person", {ShapeKind::kCylinder, 0.5, 0.5, 1.7}, -2.0, 1.0, 0);
  SemanticSlam slam(
      setupWith(kFakeObjects + "[tracking]\nenabled = false\n[landmarks]\ndoubt_by_scan = false\n"));
  const SlamResult result = drive(slam);
  ASSERT_EQ(result.map.landmarks.size(), 2u) << "the person is no landmark";
  for (const auto& landmark : result.map.landmarks) {
    const auto& truth = fakes::world().objects[landmark.class_name == "sofa" ? 0 : 1];
    EXPECT_EQ(landmark.class_name, truth.class_name);
    EXPECT_LT((landmark.position - truth.world_from_object.translation()).norm(), 0.05)
        << landmark.class_name;
    EXPECT_EQ(landmark.has_yaw, truth.class_name == "sofa");
    EXPECT_LT(landmark.has_yaw ? std::abs(wrapAngle(landmark.yaw - 2.8)) : 0.0, 0.05);
    EXPECT_NEAR(landmark.shape.width, truth.shape.width, 1e-3);
    EXPECT_GT(landmark.existence, 0.99);
    EXPECT_GT(landmark.observations, 10);
    EXPECT_TRUE(slam.graph().hasLandmark(landmark.id));
  }
  EXPECT_GT(slam.graph().landmarks(), 2u) << "views";
}

// The camera alone, which sees its objects and not where it is, while it moves at first slowly and then fast.
TEST_F(ObjectStagesTest, NothingIsMappedFromPosesThatAreOnlyHeld) {
  constexpr double kFrom = 3, kUntil = 6;
  furnish();
  fakes::world().not_tracked = {kFrom, kUntil};
  fakes::world().world_from_camera = [](double t) {
    const double share = std::clamp((t - kFrom) / (kUntil - kFrom), 0.0, 1.0);
    if (share > 0 && share < 1) t = kFrom + (kUntil - kFrom) * std::pow(share, 4);
    return toPose3(Drive::truth(t)) * Drive::robotFromCamera();
  };
  SemanticSlam slam(setupWith(kFakeObjects + "[tracking]\nclass = FakeOdometry\n[lidar]\nenabled = false\n[odometry]\nenabled = false\n"));
  for (int i = 0; i <= 120; ++i) slam.process(Drive::frame(0.1 * i));
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.frames_lost, 30);
  ASSERT_GE(result.map.landmarks.size(), 4u);
  for (const auto& landmark : result.map.landmarks) {
    double off_m = 1e9;
    for (const auto& object : fakes::world().objects)
      if (object.class_name == landmark.class_name)
        off_m = std::min(off_m, (object.world_from_object.translation() - landmark.position).head<2>().norm());
    EXPECT_LT(off_m, 0.1) << landmark.class_name << " at " << landmark.position.transpose();
  }
}

TEST_F(ObjectStagesTest, WithoutLandmarksPeopleAreStillKeptOut) {
  for (const bool enabled : {true, false}) {
    fakes::world().objects.clear();
    fakes::world().masked.clear();
    place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
    place("person", {ShapeKind::kCylinder, 0.5, 0.5, 1.7}, 3.0, 0, 0);
    SemanticSlam slam(setupWith(kFakeObjects + "[tracking]\nclass = FakeOdometry\n[landmarks]\nenabled = " +
                                (enabled ? "true" : "false") + "\n"));
    EXPECT_EQ(drive(slam).candidates.size(), enabled ? 1u : 0u);
    EXPECT_EQ(fakes::world().masked.at(0).size(), 1u);
  }
}

TEST_F(ObjectStagesTest, WhatBeamsCrossIsNotInTheMap) {
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 1.0}, 3.5, 1.0, 2.8);
  place("swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, 0.5, 2.9, 0);
  SemanticSlam slam(
      setupWith("[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n"
                "[tracking]\nenabled = false\n"));
  const SlamResult result = drive(slam);
  ASSERT_EQ(result.candidates.size(), 2u);
  for (const auto& [landmark, evidence] : result.candidates) {
    const bool is_sofa = landmark.class_name == "sofa";
    EXPECT_NEAR(evidence.beams_crossed, is_sofa ? 1 : 0, 1e-9) << "a sofa is solid below, a chair is not";
    EXPECT_EQ(landmark.existence > 0.5, !is_sofa);
    EXPECT_GT(evidence.sightings, 1);
  }
  ASSERT_EQ(result.map.landmarks.size(), 1u);
  EXPECT_EQ(result.map.landmarks[0].class_name, "swivel_chair");
}

// Place, yaw, size and covariance of one estimate, to the last bit.
TEST_F(ObjectStagesTest, TheMapIsTheOptimumOfTheGraph) {
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
  place("swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, 0.5, 2.9, 0);
  SemanticSlam slam(
      setupWith(kFakeObjects + "[tracking]\nenabled = false\n[landmarks]\ndoubt_by_scan = false\n"));
  const SlamResult result = drive(slam);
  ASSERT_EQ(result.map.landmarks.size(), 2u);
  const auto covariances = slam.graph().landmarkCovariances();
  ASSERT_TRUE(covariances);
  for (const auto& landmark : result.map.landmarks) {
    const LandmarkEstimate optimum = slam.graph().landmark(landmark.id);
    EXPECT_EQ(landmark.position, optimum.position);
    EXPECT_EQ(landmark.yaw, optimum.yaw);
    EXPECT_EQ(landmark.shape.width, optimum.shape.width);
    EXPECT_EQ(landmark.shape.depth, optimum.shape.depth);
    EXPECT_EQ(landmark.shape.height, optimum.shape.height);
  }
  for (const auto& [landmark, evidence] : result.candidates) {
    Eigen::Matrix4d expected = covariances->at(landmark.id);
    expected.diagonal().head<2>().array() += 0.02 * 0.02;
    EXPECT_TRUE(landmark.covariance.isApprox(expected, 1e-12)) << "of the middle of its shape, and of that within it";
  }
  for (const auto& [candidate, evidence] : result.candidates) {
    for (const auto& landmark : result.map.landmarks) {
      if (candidate.id == landmark.id) {
        EXPECT_EQ(landmark.covariance, candidate.covariance) << "the same estimate";
      }
    }
  }
  const TemporaryFolder folder;
  slam.graph().saveG2o(folder.file("graph.g2o"));
  const auto content = loadG2o(folder.file("graph.g2o"));
  const auto& saved = std::get<FactorGraph>(content.graph);
  for (const auto& landmark : result.map.landmarks) {
    EXPECT_LT((saved.landmark(landmark.id).position - landmark.position).norm(), 1e-12);
    EXPECT_NEAR(saved.landmark(landmark.id).yaw, landmark.yaw, 1e-9);
    EXPECT_EQ(saved.landmark(landmark.id).shape.width, landmark.shape.width);
  }
  EXPECT_TRUE(saved.landmarkCovariances()) << "every landmark is tied to the poses, through its views";
}

TEST_F(ObjectStagesTest, WhatIsGoneWhenTheCameraComesBackIsNotInTheMap) {
  const fakes::WorldObject chair{
      "swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, poseFromYpr(3, -0.5, 0, 0, 0, 0)};
  for (const bool removed : {false, true}) {
    fakes::world().objects = {chair};
    SemanticSlam slam(setupWith(kFakeObjects + "[tracking]\nenabled = false\n"));
    Drive world;
    for (int i = 0; i <= 490; ++i) {
      if (removed && i == 120) fakes::world().objects.clear();
      slam.process(world.odometry(0.1 * i));
      slam.process(world.scan(0.1 * i));
      if (i % 2) continue;
      Frame frame = Drive::frame(0.1 * i);
      frame.depth.setTo(6);  // nothing hides it
      slam.process(frame);
    }
    const SlamResult result = slam.finish();
    ASSERT_EQ(result.candidates.size(), 1u);
    EXPECT_EQ(result.map.landmarks.size(), removed ? 0u : 1u) << result.candidates[0].landmark.existence;
  }
}

// The associator was not sure; the model is.
TEST_F(ObjectStagesTest, HindsightDecidesAgainWhoIsWho) {
  const ObjectShape chair{ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  place("swivel_chair", chair, 3.4, 0, 0);
  place("swivel_chair", chair, 3.4, 0.8, 0);
  SemanticSlam slam(
      setupWith(kFakeObjects + "[association]\nclass = FakeAssociator\n[tracking]\nenabled = false\n"));
  const SlamResult result = drive(slam);
  ASSERT_EQ(result.map.landmarks.size(), 2u);
  for (const auto& landmark : result.map.landmarks) {
    const auto& truth = fakes::world().objects[landmark.position.y() < 0.4 ? 0 : 1];
    EXPECT_LT((landmark.position - truth.world_from_object.translation()).norm(), 0.05);
  }
  for (const auto& frame : slam.objects().frames())
    for (const auto& decision : frame.decisions) EXPECT_GT(decision.association.probability, 0.9);
}

TEST_F(ObjectStagesTest, TheDetectorRunsOnEveryNthFrame) {
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
  SemanticSlam slam(
      setupWith("[detection]\nclass = FakeDetector\nevery_nth_frame = 3\n[proposals]\nclass = "
                "FakeProposals\n[tracking]\nenabled = false\n"));
  drive(slam);
  EXPECT_EQ(fakes::world().detector_calls, 21) << "of 61 frames";
}

TEST_F(ObjectStagesTest, SightingsReachTheSinks) {
  struct Watcher : Sink {
    void onStep(const StepReport& report) override {
      frames += report.kind == StepReport::Kind::kFrame;
      detections += report.detections.boxes.size();
      decisions += report.decisions.size();
    }
    std::size_t frames = 0, detections = 0, decisions = 0;
  };
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
  SemanticSlam slam(setupWith(kFakeObjects + "[tracking]\nenabled = false\n"));
  const auto watcher = std::make_shared<Watcher>();
  slam.addSink(watcher);
  drive(slam);
  EXPECT_EQ(watcher->frames, 61u);
  EXPECT_GT(watcher->detections, 5u);
  EXPECT_EQ(watcher->decisions, watcher->detections);
}

// A camera in the hand, tilted, 1.4 m above a floor that its tracker knows nothing of.
TEST_F(ObjectStagesTest, HandheldCameraIsLevelledByTheFloor) {
  const Pose3 forward_from_optical = poseFromYpr(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
  fakes::world().world_from_camera = [&](double t) {
    const Pose2 pose = Drive::truth(t);
    const Pose3 held =
        poseFromYpr(pose.x, pose.y, 1.4, pose.yaw, 0.4 + 0.05 * std::sin(t), 0.1 * std::cos(t));
    return held * forward_from_optical;
  };
  place("sofa", {ShapeKind::kCuboid, 1.8, 0.9, 0.8}, 3.5, 1.0, 2.8);
  SemanticSlam slam(
      setupWith(kFakeObjects + "[tracking]\nclass = FakeOdometry\n[ground]\nclass = FakeFloors\n"));
  for (int i = 0; i <= 120; ++i) {
    Frame frame = Drive::frame(0.1 * i);
    frame.robot_from_camera = forward_from_optical;  // nobody says where it is held
    slam.process(frame);
  }
  const SlamResult result = slam.finish();
  EXPECT_FALSE(result.map.planar);
  ASSERT_EQ(result.world_from_camera.size(), 121u);
  const Pose3 moved = fakes::world().world_from_camera(0) * result.world_from_camera[0].pose.inverse();
  EXPECT_LT((moved.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 0.01) << "level";
  for (const auto& stamped : result.world_from_camera) {
    const Pose3 error = fakes::world().world_from_camera(stamped.t).inverse() * moved * stamped.pose;
    EXPECT_NEAR(stamped.pose.translation().z(), 1.4, 0.02) << stamped.t;
    EXPECT_LT(error.translation().norm(), 0.03) << stamped.t;
    EXPECT_LT(rotationAngle(error), 0.02) << stamped.t;
  }
  ASSERT_EQ(result.map.landmarks.size(), 1u);
  const Eigen::Vector3d sofa = moved * result.map.landmarks[0].position;
  EXPECT_LT((sofa - Eigen::Vector3d(3.5, 1.0, 0)).norm(), 0.05);
}

TEST_F(ObjectStagesTest, UnknownStageIsAnErrorThatListsTheKnown) {
  try {
    setupWith("[detection]\nclass = FakeDetectr\n");
    FAIL() << "no exception";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("FakeDetector"), std::string::npos) << error.what();
  }
}

// The camera is lost while the robot drives a quarter lap; it goes on as if it stood where it was lost, and
// maps everything a second time. The objects say where it is.
TEST_F(ObjectStagesTest, ObjectsBringBackALostCamera) {
  furnish();
  fakes::world().lost_at = 15;
  for (const bool enabled : {true, false}) {
    SemanticSlam slam(setupWith(kFakeObjects +
                                 "[tracking]\nclass = FakeOdometry\n[object_loop_closing]\nenabled = " +
                                 (enabled ? "true" : "false") + "\n"));
    for (int i = 0; i <= 270; ++i)
      if (i <= 120 || i >= 150) slam.process(Drive::frame(0.1 * i));
    const SlamResult result = slam.finish();
    const Pose3 error = result.world_from_robot.back().pose.inverse() *
                        toPose3(Drive::truth(result.world_from_robot.back().t));
    EXPECT_EQ(result.map.landmarks.size() == 6, enabled);
    EXPECT_EQ(result.counts.loop_closures > 0, enabled);
    EXPECT_EQ(error.translation().norm() < 0.1 && rotationAngle(error) < 0.05, enabled)
        << error.translation().norm() << " m, " << rotationAngle(error) << " rad";
  }
}

// A second run starts elsewhere in the room that the first one mapped.
TEST_F(ObjectStagesTest, ObjectsTellWhereInAnEarlierMapTheRunIs) {
  furnish();
  const std::string config = kFakeObjects + "[tracking]\nenabled = false\n";
  SemanticSlam first(setupWith(config));
  CSemanticMap map = drive(first).map;
  ASSERT_EQ(map.landmarks.size(), 6u);
  Landmark gone = map.landmarks.front();  // what is not seen again stays in the map
  gone.position = {9, 9, 0};
  gone.id = LandmarkId{99};
  map.landmarks.push_back(gone);

  SemanticSlam second(setupWith(config));
  second.setMap(map);
  Drive world;
  for (int i = 40; i <= 130; ++i) {
    second.process(world.odometry(0.1 * i));
    second.process(world.scan(0.1 * i));
    if (i % 2 == 0) second.process(Drive::frame(0.1 * i));
  }
  const SlamResult result = second.finish();
  const auto& last = result.world_from_robot.back();
  const Pose3 error = last.pose.inverse() * toPose3(Drive::truth(last.t));
  EXPECT_LT(error.translation().norm(), 0.1);
  EXPECT_LT(rotationAngle(error), 0.05);
  EXPECT_EQ(result.map.landmarks.size(), 7u);
  ASSERT_TRUE(result.earlier);
  EXPECT_TRUE(result.earlier->recognised);
  EXPECT_GE(result.earlier->common, 3);

  for (std::size_t i = 0; i < 6; ++i) {
    const auto same = std::find_if(
        result.map.landmarks.begin(), result.map.landmarks.end(),
        [&](const Landmark& now) { return (now.position - map.landmarks[i].position).norm() < 0.2; });
    ASSERT_NE(same, result.map.landmarks.end()) << i;
    EXPECT_EQ(same->id, map.landmarks[i].id) << "an object keeps its id";
  }

  // Objects that stand elsewhere are not recognised, and that is said.
  for (auto& landmark : map.landmarks) landmark.position *= 1.7;
  map.occupancy.reset();
  SemanticSlam third(setupWith(config));
  third.setMap(map);
  const auto own = drive(third);
  ASSERT_TRUE(own.earlier);
  EXPECT_FALSE(own.earlier->recognised);
  EXPECT_NE(own.earlier->missing.find("a grid for scans, views for images"), std::string::npos);
  EXPECT_LT((own.world_from_robot.front().pose.translation()).norm(), 0.05);
}

}  // namespace
}  // namespace roomgraph::test
