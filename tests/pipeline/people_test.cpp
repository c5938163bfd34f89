// SPDX-License-Identifier: BSD-3-Clause
// People in view: wedges around them, how long they hold, and that boxes end with the frame they were found in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drive.h"
#include "fake_stages.h"
#include "people_in_view.h"

namespace roomgraph::test {
namespace {

ObjectDatabase chairsAndPeople() {
  return ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\n[person]\nlabels = person\nlandmark = false\n");
}

Proposal standingAt(const std::string& class_name, double x, double y) {
  Proposal out;
  out.class_name = class_name;
  out.shape = {ShapeKind::kCylinder, 0.5, 0.5, 1.7};
  out.camera_from_object = Drive::robotFromCamera().inverse() * poseFromYpr(x, y, 0, 0, 0, 0);
  return out;
}

// Beams of one degree, all round; everything 5 m away.
Scan roundScan(double t) {
  Scan scan;
  scan.t = t;
  scan.angle_min_rad = -M_PI;
  scan.angle_step_rad = M_PI / 180;
  scan.max_range_m = 20;
  scan.ranges_m.assign(360, 5);
  scan.valid.assign(360, true);
  return scan;
}

TEST(People, BoxesAreThoseOfClassesThatAreNoLandmarks) {
  std::vector<Detection> detections(2);
  detections[0].class_name = "person";
  detections[0].box = {1, 2, 3, 4};
  detections[1].class_name = "swivel_chair";
  const auto boxes = boxesOfPeople(detections, chairsAndPeople());
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].v_max, 4);
}

// A scan .2 s after the image, of a robot that drives and turns meanwhile: the wedge is where the person stands.
TEST(People, WedgesStayWithThePersonWhileTheRobotMoves) {
  FrameProposals proposals;
  proposals.t = 7;
  proposals.proposals = {standingAt("person", 2.5, 0.3)};
  const auto people = peopleInView(proposals, Drive::robotFromCamera(), chairsAndPeople());
  const Pose2 before_from_after{0.2, 0.05, 0.3};
  const auto moved = seenAfter(people, before_from_after);
  EXPECT_EQ(moved.t, people.t);
  const auto returnsAt = [&](const Eigen::Vector2d& in_before) {
    const Eigen::Vector2d place = before_from_after.inverse() * in_before;
    Scan scan = roundScan(7.2);
    scan.angle_min_rad = std::atan2(place.y(), place.x());
    scan.ranges_m.assign(1, static_cast<float>(place.norm()));
    scan.valid.assign(1, true);
    return scan;
  };
  for (const double y : {0.0, 0.3, 0.6}) {
    Scan scan = returnsAt({2.5, y});
    EXPECT_EQ(removePeople(scan, moved), 1) << y;
  }
  for (const double y : {-0.4, 1.0}) {
    Scan scan = returnsAt({2.5, y});
    EXPECT_EQ(removePeople(scan, moved), 0) << y;
  }
  Scan unmoved = returnsAt({2.5, 0.3});
  EXPECT_EQ(removePeople(unmoved, people), 0) << "as the wedge has another direction by then";
}

TEST(People, WedgeHoldsThePersonAndNoMore) {
  FrameProposals proposals;
  proposals.t = 7;
  proposals.proposals = {standingAt("person", 2, 2), standingAt("swivel_chair", 3, 0)};
  const auto people = peopleInView(proposals, Drive::robotFromCamera(), chairsAndPeople());
  EXPECT_EQ(people.t, 7);
  ASSERT_EQ(people.wedges.size(), 1u) << "a chair is no person";
  const auto& wedge = people.wedges[0];
  const double distance = std::sqrt(8.0), half = std::atan2(0.25 + 0.15, distance);
  EXPECT_NEAR(wedge.angle_min_rad, M_PI / 4 - half, 1e-9);
  EXPECT_NEAR(wedge.angle_max_rad, M_PI / 4 + half, 1e-9);
  EXPECT_NEAR(wedge.range_near_m, distance - 0.6, 1e-9);
  EXPECT_NEAR(wedge.range_far_m, distance + 0.6, 1e-9);
}

TEST(People, ReturnsInTheWedgeGoAsLongAsItIsFresh) {
  const PeopleInView people{7, {{0.2, 0.5, 4.5, 5.5}}};
  for (const double t : {6.8, 7.0, 7.2}) {
    Scan scan = roundScan(t);
    const int removed = removePeople(scan, people);
    EXPECT_NEAR(removed, 0.3 * 180 / M_PI, 1.5) << t;
    EXPECT_EQ(std::count(scan.valid.begin(), scan.valid.end(), false), removed);
    for (int i = 0; i < 360; ++i) {
      const double angle = scan.angle_min_rad + i * scan.angle_step_rad;
      if (angle < 0.19 || angle > 0.51) { EXPECT_TRUE(scan.valid[static_cast<std::size_t>(i)]) << angle; }
    }
  }
  for (const double t : {6.6, 7.4}) {
    Scan scan = roundScan(t);
    EXPECT_EQ(removePeople(scan, people), 0) << "the person may be elsewhere at " << t;
  }
}

// The person walks out of the picture while the detector fails: their box must not go on hiding the wall behind.
TEST(People, BoxesDoNotOutliveTheirDetection) {
  registerAllClasses();
  fakes::registerClasses();
  fakes::world() = {};
  fakes::world().world_from_camera = [](double t) { return toPose3(Drive::truth(t)) * Drive::robotFromCamera(); };
  fakes::world().objects = {{"person", {ShapeKind::kCylinder, 0.5, 0.5, 1.7}, poseFromYpr(2.5, 0, 0, 0, 0, 0)}};
  fakes::world().detector_fails_from = 0.15;
  SemanticSlam slam(setupWith("[detection]\nclass = FakeDetector\ntrack_boxes = false\n[proposals]\nclass = "
                              "FakeProposals\n[tracking]\nclass = FakeOdometry\n"));
  for (const double t : {0.0, 0.1, 0.2, 0.3}) slam.process(Drive::frame(t));
  const auto& masked = fakes::world().masked;
  ASSERT_EQ(masked.size(), 4u);
  EXPECT_EQ(masked[0].size(), 1u);
  EXPECT_EQ(masked[1].size(), 1u);
  EXPECT_TRUE(masked[2].empty()) << "nobody knows where the person is";
  EXPECT_TRUE(masked[3].empty());
}

}  // namespace
}  // namespace roomgraph::test
