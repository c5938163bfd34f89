// SPDX-License-Identifier: BSD-3-Clause
// What speaks against a landmark: plain view without a detection, and beams; and what does not.
#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/estimation/object_mapper.h"
#include "roomgraph/geometry/projection.h"
#include "still_camera.h"
#include "visibility.h"

namespace roomgraph::test {
namespace {

constexpr double kWall_m = 5;

// A camera 1 m above the floor that looks along x, at a wall.
Frame viewOfAWall(double depth_m = kWall_m) {
  Frame frame;
  frame.camera = {320, 240, 260, 260, 159.5, 119.5, {}};
  frame.robot_from_camera = poseFromYpr(0, 0, 1, 0, 0, 0);
  frame.robot_from_camera.linear() = bodyFromOptical();
  frame.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(depth_m));
  return frame;
}

Landmark chairStandingAt(double x, double y) {
  Landmark out;
  out.class_name = "swivel_chair";
  out.shape = {ShapeKind::kCylinder, 0.6, 0.6, 0.9};
  out.position = {x, y, 0};
  return out;
}

Detection boxAround(const Landmark& landmark, const Frame& frame, const std::string& label) {
  Detection out;
  out.class_name = out.label = label;
  out.box = projectShape(landmark.shape, frame.robot_from_camera.inverse() * landmark.worldFromObject(), frame.camera)
                ->visible;
  return out;
}

bool expected(const Landmark& landmark, const Frame& frame, const std::vector<Detection>& detections = {}) {
  return shouldBeSeen(landmark, frame, frame.robot_from_camera, detections);
}

TEST(ShouldBeSeen, InPlainViewBetweenOneAndFourMetres) {
  EXPECT_TRUE(expected(chairStandingAt(2.5, 0), viewOfAWall()));
  EXPECT_TRUE(expected(chairStandingAt(3.9, 0), viewOfAWall()));
  EXPECT_FALSE(expected(chairStandingAt(4.1, 0), viewOfAWall()));
  EXPECT_FALSE(expected(chairStandingAt(0.9, 0), viewOfAWall()));
  EXPECT_FALSE(expected(chairStandingAt(-2.5, 0), viewOfAWall())) << "behind the camera";
}

TEST(ShouldBeSeen, NotWhenSomethingHidesIt) {
  EXPECT_FALSE(expected(chairStandingAt(2.5, 0), viewOfAWall(1.5)));
  // Margin: 0.3 m and half the width, so that the chair's own front does not hide it.
  EXPECT_TRUE(expected(chairStandingAt(2.5, 0), viewOfAWall(2.2)));
  Frame half = viewOfAWall();
  half.depth(cv::Rect(0, 0, 160, 240)) = 1.5F;
  EXPECT_FALSE(expected(chairStandingAt(2.5, 0), half));
  EXPECT_FALSE(expected(chairStandingAt(2.5, 0), viewOfAWall(0))) << "nobody knows what is before it";
  Frame none = viewOfAWall();
  none.depth = cv::Mat();
  EXPECT_FALSE(expected(chairStandingAt(2.5, 0), none));
}

// Half the image is 31.6 degrees wide: at 2.5 m its border is 1.53 m beside the axis.
TEST(ShouldBeSeen, NotWhenTheImageBorderCutsIt) {
  EXPECT_TRUE(expected(chairStandingAt(2.5, 1.1), viewOfAWall()));
  EXPECT_FALSE(expected(chairStandingAt(2.5, 1.55), viewOfAWall()));
}

TEST(ShouldBeSeen, NotWhenItIsTooSmall) {
  Landmark low = chairStandingAt(3.5, 0);
  low.shape.height = 0.1;  // about 7 px and the top face, 14 px; a tenth of the image is 24
  EXPECT_FALSE(expected(low, viewOfAWall()));
}

TEST(ShouldBeSeen, ADetectionOfWhateverLabelIsEnough) {
  const Landmark chair = chairStandingAt(2.5, 0);
  const Frame frame = viewOfAWall();
  EXPECT_FALSE(expected(chair, frame, {boxAround(chair, frame, "sofa")}));
  EXPECT_TRUE(expected(chair, frame, {boxAround(chairStandingAt(2.5, 1), frame, "sofa")}));
}

class Doubts : public ::testing::Test {
 protected:
  Doubts()
      : source_(MotionNoise{}, true), motion_{source_, source_, source_}, poses_(motion_),
        mapper_(nearestNeighbor(), {}, 0.03, poses_) {
    poses_.add(0, Pose3::Identity());
  }
  static std::shared_ptr<Associator> nearestNeighbor() {
    association::registerClasses();
    return createStage<Associator>("NearestNeighborAssociator", "test");
  }
  std::vector<ObjectDecision> see(const std::vector<Landmark>& objects) {
    Frame frame = viewOfAWall();
    frame.id = FrameId{0};
    std::vector<ObjectMeasurement> measurements;
    for (const auto& object : objects) {
      ObjectMeasurement out;
      out.frame = frame.id;
      out.proposal.class_name = out.proposal.model = out.detection.class_name = object.class_name;
      out.proposal.shape = object.shape;
      out.proposal.camera_from_object = frame.robot_from_camera.inverse() * object.worldFromObject();
      out.proposal.covariance = 0.01 * Eigen::Matrix4d::Identity();
      out.proposal.score = 0.9;
      measurements.push_back(out);
    }
    return mapper_.associate(measurements, frame, {}, noDrift());
  }
  double existence(const ObjectDecision& of) const { return mapper_.landmarks().find(of.landmark)->existence; }
  static double after(double existence, double likelihood_ratio) {
    return likelihood_ratio * existence / (likelihood_ratio * existence + 1 - existence);
  }

  MotionSource source_;
  Motion motion_;
  KeyPoses poses_;
  ObjectMapper mapper_;
};

TEST_F(Doubts, AMissFollowsBayesRuleForTheLandmarkThatWasMissed) {
  const Landmark seen = chairStandingAt(2.5, 0.7), missed = chairStandingAt(2.5, -0.7);
  const auto decisions = see({seen, missed, chairStandingAt(-2.5, 0)});
  ASSERT_EQ(decisions.size(), 3u);
  const double before = existence(decisions[0]);
  const Frame frame = viewOfAWall();
  // The first one's box was taken for something else, far off: its decision alone says that it was seen.
  mapper_.missUnseen({decisions[0]}, {}, frame);
  EXPECT_EQ(existence(decisions[0]), before);
  const LandmarkOptions options;
  EXPECT_NEAR(existence(decisions[1]),
              after(before, (1 - options.detection_probability) / (1 - options.false_alarm_probability)), 1e-12);
  EXPECT_EQ(existence(decisions[2]), before) << "it is behind the camera";
}

TEST_F(Doubts, WhatWasNotLookedForIsNotMissed) {
  const auto decisions = see({chairStandingAt(2.5, 0.7)});
  const double before = existence(decisions[0]);
  const std::string chair = chairStandingAt(2.5, 0.7).class_name;
  mapper_.missUnseen({}, {}, viewOfAWall(), {"sofa", chair});
  EXPECT_EQ(existence(decisions[0]), before);
  mapper_.missUnseen({}, {}, viewOfAWall(), {"sofa"});
  EXPECT_LT(existence(decisions[0]), before);
}

// The graph may put a landmark elsewhere; what it does not speak of stays.
TEST_F(Doubts, EstimatesOfTheGraphAreTakenOver) {
  const auto decisions = see({chairStandingAt(2.5, 0.7), chairStandingAt(2.5, -0.7)});
  const ObjectShape shape = mapper_.landmarks().find(decisions[0].landmark)->shape;
  mapper_.apply({{decisions[0].landmark, {.position = {2.6, 0.9, 0.01}, .yaw = 0.3, .shape = shape}}});
  EXPECT_EQ(mapper_.landmarks().find(decisions[0].landmark)->position, Eigen::Vector3d(2.6, 0.9, 0.01));
  EXPECT_EQ(mapper_.landmarks().find(decisions[0].landmark)->yaw, 0.3);
  EXPECT_LT((mapper_.landmarks().find(decisions[1].landmark)->position - Eigen::Vector3d(2.5, -0.7, 0)).norm(), 1e-9);
}

// Its sightings have made it another class since the graph was built.
TEST_F(Doubts, EstimatesOfAnotherShapeAreNot) {
  const auto decisions = see({chairStandingAt(2.5, 0.7)});
  mapper_.apply({{decisions[0].landmark, {.position = {2.6, 0.9, 0.01}, .yaw = 0.3, .shape = {ShapeKind::kCuboid, 1.8, 0.9, 0.8}}}});
  EXPECT_LT((mapper_.landmarks().find(decisions[0].landmark)->position - Eigen::Vector3d(2.5, 0.7, 0)).norm(), 1e-9);
}

// All beams between -10 and 10 degrees end at 6 m, far behind the sofa.
TEST_F(Doubts, BeamsThroughASofaCountOncePerPlace) {
  Landmark sofa = chairStandingAt(3, 0);
  sofa.class_name = "sofa";
  sofa.shape = {ShapeKind::kCuboid, 0.8, 0.8, 0.8};
  const auto decisions = see({sofa});
  Scan scan;
  scan.ranges_m.assign(21, 6);
  scan.valid.assign(21, 1);
  scan.angle_min_rad = -10 * M_PI / 180;
  scan.angle_step_rad = M_PI / 180;
  scan.max_range_m = 12;
  scan.robot_from_lidar.translation().z() = 0.25;
  const double before = existence(decisions[0]);
  const auto database = ObjectDatabase::fromText("[sofa]\nlabels = couch\nsolid_share = 0.4\n");
  mapper_.observe(scan, Pose3::Identity(), database);
  const double once = existence(decisions[0]);
  // Within 0.2 m of the middle: asin(.2 / 3) = 3.8 degrees, 7 beams.
  EXPECT_NEAR(once, after(before, std::exp(-7 * LandmarkOptions{}.ray_gain)), 1e-12);
  mapper_.observe(scan, poseFromYpr(0.1, 0, 0, 0.1, 0, 0), database);
  EXPECT_EQ(existence(decisions[0]), once) << "the robot stands still";
  mapper_.observe(scan, poseFromYpr(0.3, 0, 0, 0, 0, 0), database);
  EXPECT_LT(existence(decisions[0]), once);
}

}  // namespace
}  // namespace roomgraph::test
