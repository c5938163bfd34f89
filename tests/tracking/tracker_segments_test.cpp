// SPDX-License-Identifier: BSD-3-Clause
// Where a segment of tracking ends and another begins: views found in older places.
#include <gtest/gtest.h>

#include "textured_room.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

const test::TexturedRoom& cell() {
  static const test::TexturedRoom kCell;
  return kCell;
}

TrackingParameters byFeatures() {
  TrackingParameters parameters;
  parameters.dense_alignment = false;
  return parameters;
}

Pose3 turnedBy(double degrees) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({0, degrees * M_PI / 180, 0});
  return pose;
}

// Where the map has drifted, the older place is not where the path says: there is no step from the one to the other.
TEST(TrackerSegments, ASegmentBeginsWhereAViewIsFoundFarFromTheLastOne) {
  Tracker tracker(byFeatures());
  int t = 0;
  for (; t <= 30; ++t) ASSERT_TRUE(tracker.track(cell().render(t, turnedBy(6 * t)), {}).tracked) << t;
  tracker.takeLoopClosures();
  const auto back = tracker.track(cell().render(t, turnedBy(3)), {});
  ASSERT_TRUE(back.tracked);
  EXPECT_EQ(back.segment, 1);
  EXPECT_EQ(back.reason, "found again in another place");
  EXPECT_EQ(back.step_covariance, Matrix6d(Matrix6d::Identity())) << "nothing known";
  const auto closures = tracker.takeLoopClosures();
  ASSERT_EQ(closures.size(), 1u);
  EXPECT_EQ(closures[0].t_b, t);
  const Pose3 a_from_b = turnedBy(6 * closures[0].t_a).inverse() * turnedBy(3);
  EXPECT_LT(rotationAngle(a_from_b.inverse() * closures[0].a_from_b), 0.01);

  const auto next = tracker.track(cell().render(t + 1, turnedBy(6)), {});
  EXPECT_EQ(next.segment, 1);
  EXPECT_TRUE(tracker.takeLoopClosures().empty());
  const auto trajectory = tracker.trajectory();
  EXPECT_FALSE(trajectory.between(t - 1, t));
  ASSERT_TRUE(trajectory.between(t, t + 1));
  EXPECT_NEAR(rotationAngle(*trajectory.between(t, t + 1)), 3 * M_PI / 180, 0.005);
}

TEST(TrackerSegments, ASegmentGoesOnWhereOtherSensorsSayThatTheViewIsThere) {
  const auto segmentAfter = [](double degrees_by_wheels) {
    Tracker tracker(byFeatures());
    int t = 0;
    for (; t <= 30; ++t) tracker.track(cell().render(t, turnedBy(6 * t)), {});
    tracker.takeLoopClosures();
    const auto back = tracker.track(cell().render(t, turnedBy(3)), {.previous_from_current = turnedBy(degrees_by_wheels)});
    EXPECT_TRUE(back.tracked);
    EXPECT_EQ(tracker.takeLoopClosures().size(), back.segment == 0 ? 0 : 1);
    return back.segment;
  };
  EXPECT_EQ(segmentAfter(3 - 180 + 5), 0);
  EXPECT_EQ(segmentAfter(3 - 180 + 12), 1) << "further off than wheels err by";
}

// 40 degrees to the right of the first keyframe, then to the left of it: the two views have nothing in common, each something with that.
TEST(TrackerSegments, ASegmentGoesOnWhereAKeyframeOfTheSamePlaceFindsTheView) {
  Tracker tracker(byFeatures());
  int t = 0;
  for (; t <= 10; ++t) ASSERT_TRUE(tracker.track(cell().render(t, turnedBy(4 * t)), {}).tracked) << t;
  const auto back = tracker.track(cell().render(t, turnedBy(-30)), {});
  ASSERT_TRUE(back.tracked);
  EXPECT_EQ(back.segment, 0);
  EXPECT_TRUE(tracker.takeLoopClosures().empty());
}

}  // namespace
}  // namespace roomgraph::tracking
