// SPDX-License-Identifier: BSD-3-Clause
// ObjectMapper: sightings follow a landmark that is split in two.
#include "roomgraph/pipeline/object_mapper.h"

#include <gtest/gtest.h>

#include <set>

#include "drive.h"
#include "fake_stages.h"

namespace roomgraph::testing {
namespace {

const Motion& standing() {
  static const MotionNoise noise;
  static const Motion motion{MotionSource(noise, true), MotionSource(noise, false),
                             MotionSource(noise, true)};
  return motion;
}

// Two chairs .8 m apart, in view one at a time; the associator takes them for one.
TEST(ObjectMapper, WhenALandmarkIsPartedItsSightingsAre) {
  registerAllClasses();
  fakes::registerClasses();
  fakes::world() = {};
  fakes::world().world_from_camera = [](double) { return Drive::robotFromCamera(); };
  const auto stages = stagesWith(
      "[proposals]\nclass = FakeProposals\n[detection]\nclass = FakeDetector\n[selection]\nclass = "
      "BestScoreSelector\n[association]\nclass = NearestNeighborAssociator\nmax_distance_ratio = 5\n");
  KeyPoses poses(standing());
  poses.add(0, Pose3::Identity());
  ObjectMapper mapper(*stages, poses);
  for (int i = 0; i < 20; ++i) {
    const double side = i % 2 ? 0.4 : -0.4;
    fakes::world().objects = {
        {"swivel_chair", {ShapeKind::kCylinder, 0.6, 0.6, 0.9}, poseFromYpr(3, side, 0, 0, 0, 0)}};
    Frame frame = Drive::frame(0);
    frame.id = FrameId{i};
    frame.t = 0.5 * i;
    const auto detections = stages->detector->detect(frame);
    ASSERT_EQ(detections->size(), 1u);
    mapper.observe(stages->proposal_generator->generate(frame, *detections, std::nullopt), frame, {});
  }
  ASSERT_EQ(mapper.landmarks().landmarks().size(), 1u);
  const SeenSpan both = mapper.seenSpans().begin()->second;
  EXPECT_EQ(both.first, 0);
  EXPECT_EQ(both.last, 9.5);
  // The world moves: what was remembered of it then must move along.
  const Pose3 moved = poseFromYpr(5, -3, 0, 2, 0, 0);
  poses.nodes()[0].world_from_robot = moved;
  mapper.moveSince(0, moved);
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

}  // namespace
}  // namespace roomgraph::testing
