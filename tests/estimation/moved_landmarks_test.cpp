// SPDX-License-Identifier: BSD-3-Clause
// Landmarks that were moved: the change in series of places, and a sofa that was pushed along its wall, by sightings and depth images.
#include "moved_landmarks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/estimation/object_mapper.h"
#include "shipped_objects.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

// Sightings once a second at these places along y, each .02 m off to either side in turn; a pause of `pause_s` before the second list.
std::vector<PlaceInTime> seenAt(const std::vector<double>& first, const std::vector<double>& second, double pause_s = 10) {
  std::vector<PlaceInTime> out;
  double t = 0;
  const auto add = [&](double y) {
    out.push_back({t, {out.size() % 2 ? 3.02 : 2.98, y}});
    t += 1;
  };
  for (const double y : first) add(y);
  t += pause_s;
  for (const double y : second) add(y);
  return out;
}

TEST(ChangeOfPlace, IsAtThePauseBetweenTheTwoPlaces) {
  const auto change = changeOfPlace(seenAt({0, 0.04, -0.02, 0, 0.01}, {0.5, 0.48, 0.5, 0.55}));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->last_t, 4);
  EXPECT_EQ(change->first_t, 15);
  EXPECT_EQ(change->before.y(), 0);
  EXPECT_EQ(change->after.y(), 0.5);
}

TEST(ChangeOfPlace, AFewSightingsOfSomethingElseAreNone) {
  const auto change = changeOfPlace(seenAt({0, 0, 2, 0, 0, 0}, {0.5, 0.5, -1.5, 0.5, 0.5}));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->last_t, 5);
  EXPECT_EQ(change->after.y(), 0.5);
}

TEST(ChangeOfPlace, OneMomentIsNoVisit) {
  auto seen = seenAt({0, 0, 0, 0}, {0.5, 0.5, 0.5});
  for (std::size_t i = 4; i < seen.size(); ++i) seen[i].t = 20 + 0.1 * static_cast<double>(i);
  EXPECT_FALSE(changeOfPlace(seen));
}

TEST(ChangeOfPlace, IsNoneWhatMayBeOnePlace) {
  EXPECT_TRUE(changeOfPlace(seenAt({0, 0, 0, 0}, {0.3, 0.3, 0.3})));
  EXPECT_FALSE(changeOfPlace(seenAt({0, 0, 0, 0}, {0.2, 0.2, 0.2}))) << "too near";
  EXPECT_FALSE(changeOfPlace(seenAt({0, 0, 0, 0}, {0.3, 0.3, 0.3}, 0))) << "without a pause";
  EXPECT_FALSE(changeOfPlace(seenAt({0, 0, 0, 0}, {0.3, 0.3}))) << "seen twice there";
  EXPECT_FALSE(changeOfPlace(seenAt({-0.2, 0.2, -0.2, 0.2, 0}, {0.1, 0.5, 0.1, 0.5, 0.3}))) << "as sightings scatter";
  EXPECT_FALSE(changeOfPlace(seenAt({0, 0.5, 0, 0.5, 0, 0.5, 0}, {0.5, 0, 0.5, 0, 0.5, 0, 0.5}))) << "to and fro";
  EXPECT_FALSE(changeOfPlace({}));
}

constexpr double kFront_m = 2.55, kWall_m = 4.5, kEver_s = -1;

// A sofa of the usual size stands 3 m ahead, its front towards the camera.
const ObjectShape& sofaShape() {
  static const ObjectShape shape = shippedObjects().find("sofa")->nominal();
  return shape;
}

// The robot stands by turns at two places a hand's breadth apart and sees the sofa, before a wall.
class Pushed : public ::testing::Test {
 protected:
  Pushed() {
    association::registerClasses();
    mapper_ = std::make_unique<ObjectMapper>(createStage<Associator>("SoftAssociator", "test"), LandmarkOptions{}, 0.03, poses_);
  }
  // Ten times, once a second. `y`: where it stands; `said`: where the detector's boxes place it, if there are any.
  void see(double y, std::optional<double> said, bool with_depth = true) {
    for (int i = 0; i < 10; ++i, ++frames_) {
      const Pose3 robot = poseFromYpr(0, frames_ % 2 ? 0.1 : -0.1, 0, 0, 0, 0);
      poses_.add(t_, robot);
      Frame frame = frameAt(frames_, t_);
      if (with_depth) frame.depth = depthOf(y, robot * frame.robot_from_camera, frame.camera);
      mapper_->look(frame, robot, {});
      if (said) mapper_->associate({measured(frame, robot, *said)}, frame, {}, noDrift());
      t_ += 1;
    }
    t_ += 20;
  }
  void follow() { mapper_->followMoved(noDrift(), kEver_s); }
  const std::vector<Landmark>& landmarks() const { return mapper_->landmarks().landmarks(); }

  KeyPoses poses_{standing()};
  std::unique_ptr<ObjectMapper> mapper_;
  double longer_m_ = 0;   // than usual, as far as boxes say from now on: by the end that is not held
  bool carried_ = false;  // from the detection before

 private:
  ObjectMeasurement measured(const Frame& frame, const Pose3& robot, double y) const {
    ObjectMeasurement out;
    out.frame = frame.id;
    out.t = frame.t;
    out.proposal.class_name = out.proposal.model = "sofa";
    out.proposal.shape = sofaShape();
    out.proposal.has_yaw = true;
    out.proposal.shape.width += longer_m_;
    out.proposal.place_by_size(1, 0) = -0.5;  // the end at the right of who sits there
    const Pose3 world_from_object = poseFromYpr(3, y, 0, M_PI, 0, 0) * Eigen::Translation3d(0, -0.5 * longer_m_, 0);
    out.proposal.camera_from_object = (robot * frame.robot_from_camera).inverse() * world_from_object;
    out.proposal.covariance = 0.02 * Eigen::Matrix4d::Identity();
    out.proposal.score = 0.9;
    out.detection.class_name = "sofa";
    out.detection.score = 0.9;
    out.detection.box = {100, 100, 200, 200};
    out.detection.carried = carried_;
    return out;
  }
  static cv::Mat depthOf(double y, const Pose3& world_from_camera, const PinholeCamera& camera) {
    cv::Mat out(camera.height, camera.width, CV_32FC1);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d at_front = world_from_camera * camera.backProject(u, v, kFront_m);
        const bool sofa = std::abs(at_front.y() - y) < sofaShape().width / 2 && at_front.z() > 0 && at_front.z() < sofaShape().height;
        out.at<float>(v, u) = static_cast<float>(sofa ? kFront_m : kWall_m);
      }
    return out;
  }
  double t_ = 0;
  int frames_ = 0;
};

TEST_F(Pushed, StandsWhereItWasSeenLastAndWhatWasSeenBeforeIsForgotten) {
  see(0, 0), see(0.8, 0.8);
  follow();
  ASSERT_EQ(landmarks().size(), 1u);
  EXPECT_NEAR(landmarks()[0].position.y(), 0.8, 1e-9);
  EXPECT_EQ(mapper_->standsSince(landmarks()[0].id), 30);
  EXPECT_EQ(mapper_->frames().size(), 10u);
  EXPECT_EQ(mapper_->seenSpans().at(landmarks()[0].id).first, 30);
  EXPECT_TRUE(mapper_->reassociate());
  EXPECT_NEAR(landmarks().at(0).position.y(), 0.8, 0.01);
  EXPECT_EQ(mapper_->standsSince(landmarks()[0].id), 30);
}

// What a detector saw beside it before turns out to be the same: rays from then are of it, too.
TEST_F(Pushed, WhatWasSeenThereBeforeItWasPushedThereStoodThere) {
  see(0, 1.5), see(0, 0), see(0.3, 0.3);
  ASSERT_EQ(landmarks().size(), 2u);
  const LandmarkId pushed = landmarks()[1].id;
  follow();
  EXPECT_EQ(mapper_->standsSince(pushed), 60);
  mapper_->tidy();
  ASSERT_EQ(landmarks().size(), 1u);
  EXPECT_FALSE(mapper_->standsSince(landmarks()[0].id));
}

TEST_F(Pushed, RaysBeforeItStoodThereSayNothingOfIt) {
  const auto crossed = [&] { return mapper_->candidates(shippedObjects(), nullptr).at(0).evidence.crossed; };
  see(0, 0), see(0, 0), see(0.8, 0.8);
  follow();
  ASSERT_TRUE(mapper_->standsSince(landmarks().at(0).id));
  EXPECT_EQ(crossed(), 0);
}

TEST_F(Pushed, BackAndForthItIsFollowedToo) {
  see(0, 0), see(0.8, 0.8);
  follow();
  see(0.1, 0.1);
  follow();
  ASSERT_EQ(landmarks().size(), 1u);
  EXPECT_NEAR(landmarks()[0].position.y(), 0.1, 1e-9);
  EXPECT_EQ(mapper_->standsSince(landmarks()[0].id), 60);
}

TEST_F(Pushed, BoxesAloneDoNotSaySo) {
  see(0, 0), see(0, 0.8);
  follow();
  EXPECT_EQ(mapper_->frames().size(), 20u) << "the depth images show it where it was";
  for (const Landmark& landmark : landmarks()) EXPECT_FALSE(mapper_->standsSince(landmark.id));
}

TEST_F(Pushed, WhereThePathMayBeAsFarOffNothingWas) {
  see(0, 0), see(0.8, 0.8);
  Drift drift(standing(), true);
  drift.extend(poses_);  // no sensor measured any movement
  mapper_->followMoved(drift, kEver_s);
  EXPECT_EQ(mapper_->frames().size(), 20u);
}

TEST_F(Pushed, NorDoTheyWithoutDepth) {
  see(0, 0, false), see(0.8, 0.8, false);
  follow();
  EXPECT_EQ(mapper_->frames().size(), 20u);
}

// Carried away: nobody sees it again, and where it was half a minute later the wall behind it is seen.
TEST_F(Pushed, WhatIsNotThereAnyMoreIsEmptied) {
  const auto emptied = [&] { return mapper_->candidates(shippedObjects(), nullptr).at(0).evidence.emptied; };
  see(0, 0);
  EXPECT_EQ(emptied(), 0) << "nobody looked";
  see(0, {});
  EXPECT_LT(emptied(), 0.1) << "it is not detected, but there";
  see(9, {});
  EXPECT_GT(emptied(), 0.9);
}

// By so much that it was taken for another one, which has no room beside the first.
TEST_F(Pushed, TheSecondLandmarkBecomesTheFirst) {
  see(0, 0), see(1.5, 1.5);
  ASSERT_EQ(landmarks().size(), 2u);
  const LandmarkId first = landmarks()[0].id;
  follow();
  ASSERT_EQ(landmarks().size(), 1u);
  EXPECT_EQ(landmarks()[0].id, first);
  EXPECT_NEAR(landmarks()[0].position.y(), 1.5, 1e-9);
  EXPECT_EQ(mapper_->standsSince(landmarks()[0].id), 30);
  for (const auto& frame : mapper_->frames()) EXPECT_EQ(frame.decisions.at(0).landmark, first);
}

TEST_F(Pushed, AnotherLengthIsNoOtherPlace) {
  see(0, 0);
  longer_m_ = 0.8;
  see(0, 0);
  EXPECT_TRUE(movedLandmarks(landmarks(), mapper_->frames(), poses_, kEver_s).empty());
  see(0, -0.4), see(0, -0.4), see(0, -0.4);
  EXPECT_FALSE(movedLandmarks(landmarks(), mapper_->frames(), poses_, kEver_s).empty()) << "another end is";
}

TEST_F(Pushed, BoxesThatWereCarriedFromTheDetectionBeforeAreNotAsked) {
  see(0, 0);
  carried_ = true;
  see(0.8, 0.8);
  follow();
  EXPECT_EQ(mapper_->frames().size(), 20u);
}

TEST_F(Pushed, WhoWasNotSightedSinceIsNotAsked) {
  see(0, 0), see(0.8, 0.8);
  mapper_->followMoved(noDrift(), 40);
  EXPECT_EQ(mapper_->frames().size(), 20u);
  mapper_->followMoved(noDrift(), 39);
  EXPECT_EQ(mapper_->frames().size(), 10u);
}

TEST_F(Pushed, FormerSightingsAreForgottenToo) {
  for (int i = 0; i < 12; ++i) see(0, 0);
  mapper_->giveUpRepeated(50, poses_.trajectory());
  ASSERT_FALSE(mapper_->frames().former().empty());
  const double pushed_t = poses_.nodes().back().t + 21;
  see(0.8, 0.8);
  follow();
  EXPECT_TRUE(mapper_->frames().former().empty());
  EXPECT_EQ(mapper_->seenSpans().at(landmarks().at(0).id).first, pushed_t);
}

// A detector may give one sofa two boxes at once: these two are none that was moved.
TEST_F(Pushed, TwoThatAreSeenInOneImageStayTwo) {
  see(0, 0), see(1.5, 1.5);
  ASSERT_EQ(landmarks().size(), 2u);
  const ObjectDecision both = mapper_->frames().back().decisions.at(0);
  ObjectFrames frames = mapper_->frames();
  frames.change(0).decisions.push_back(both);
  EXPECT_EQ(movedLandmarks(landmarks(), mapper_->frames(), poses_, kEver_s).size(), 1u);
  EXPECT_TRUE(movedLandmarks(landmarks(), frames, poses_, kEver_s).empty());
}

}  // namespace
}  // namespace roomgraph::test
