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

// Floors and doors repeat themselves: what looks like a place that no camera reaches in this time is another one.
TEST(TrackerSegments, WhereNoCameraComesInTimeAViewIsNotFound) {
  const auto findsBack = [](double after_s, const Pose3& last, const Pose3& place) {
    Tracker tracker(byFeatures());
    for (int i = 0; i <= 30; ++i) EXPECT_TRUE(tracker.track(cell().render(0.1 * i, interpolate(Pose3::Identity(), last, i / 30.0)), {}).tracked) << i;
    return tracker.track(cell().render(3 + after_s, place), {}).tracked;
  };
  EXPECT_FALSE(findsBack(0.8, turnedBy(170), turnedBy(3))) << "3 rad/s, and .15 rad";
  EXPECT_TRUE(findsBack(1.1, turnedBy(170), turnedBy(3)));
  Pose3 beside = Pose3::Identity();
  beside.translation().x() = 1.2;
  EXPECT_FALSE(findsBack(0.95, Pose3::Identity(), beside)) << "1 m/s, and .15 m";
  EXPECT_TRUE(findsBack(1.15, Pose3::Identity(), beside));
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

// Walls of one paper look alike: where a camera may have been carried anywhere, a few features do not say that it stands where it stood.
TEST(TrackerSegments, AfterAPauseOfWhichNobodyTellsAPlaceMustBeRecognised) {
  constexpr int kColumns = 320, kStep = 2;
  const auto seen = [](double pause_s, int columns, const TrackingPrior& prior) {
    Tracker tracker(byFeatures());
    for (int t = 0; t <= 4; ++t) EXPECT_TRUE(tracker.track(cell().render(t, turnedBy(4 * t)), {}).tracked) << t;
    Frame frame = cell().render(4 + pause_s, turnedBy(17));
    if (columns < frame.gray.cols) frame.gray.colRange(columns, frame.gray.cols).setTo(128);
    return tracker.track(frame, prior);
  };
  const TrackingPrior by_wheels{.previous_from_current = turnedBy(1)};
  int columns = kStep;
  while (columns < kColumns && !(seen(1, columns, {}).tracked && seen(10, columns, by_wheels).tracked)) columns += kStep;
  ASSERT_LT(seen(1, columns, {}).inliers, TrackingParameters{}.relocalisation_min_inliers) << "these few";
  EXPECT_FALSE(seen(10, columns, {}).tracked);
  EXPECT_TRUE(seen(10, columns, by_wheels).tracked);
  const auto recognised = seen(10, 10000, {});
  EXPECT_TRUE(recognised.tracked);
  EXPECT_EQ(recognised.segment, 0);
}

TEST(TrackerSegments, WhatCameOfAPauseIsNoVelocity) {
  Tracker tracker(byFeatures());
  for (int t = 0; t <= 4; ++t) ASSERT_TRUE(tracker.track(cell().render(t, turnedBy(4 * t)), {}).tracked) << t;
  const auto recognised = tracker.track(cell().render(14, turnedBy(28)), {});
  ASSERT_TRUE(recognised.tracked);
  ASSERT_EQ(recognised.segment, 0);
  Frame blind = cell().render(15, turnedBy(28));
  blind.gray = cv::Mat();
  blind.color = cv::Mat();
  const auto after = tracker.track(blind, {});
  EXPECT_FALSE(after.tracked);
  EXPECT_LT(rotationAngle(recognised.odom_from_camera.inverse() * after.odom_from_camera), 0.01);
}

// Along the corner of a room, 1 cm and half a degree a frame: three planes hold a frame without features.
Frame cornerOf(const test::TexturedRoom& walls, int i, bool features) {
  Frame frame = walls.render(i, poseFromYpr(0.6 + 0.01 * i, 0.1, 0.2, 0, 0.5 + 0.009 * i, -0.5));
  if (!features) frame.gray.setTo(128);
  return frame;
}

// Features, none, those of other wallpaper, none, and the first ones again: what ties that view to what.
std::vector<RelativePose> tiesWhenFoundAgain(const TrackingPrior& of_last) {
  Tracker tracker((TrackingParameters()));
  const test::TexturedRoom repapered(77);
  int i = 0;
  for (; i < 3; ++i) EXPECT_TRUE(tracker.track(cornerOf(cell(), i, true), {}).tracked);
  for (; i < 5; ++i) EXPECT_TRUE(tracker.track(cornerOf(cell(), i, false), {}).tracked);
  for (; i < 20; ++i) tracker.track(cornerOf(repapered, i, true), {});
  for (; i < 22; ++i) EXPECT_EQ(tracker.track(cornerOf(cell(), i, false), {}).segment, 1);
  tracker.takeLoopClosures();
  const auto back = tracker.track(cornerOf(cell(), i, true), of_last);
  EXPECT_EQ(back.segment, 2);
  EXPECT_EQ(back.reason, "found again in another place");
  return tracker.takeLoopClosures();
}

TEST(TrackerSegments, DenseAlignmentTiesAViewThatIsFoundAgainToTheLastOneWhereNoOtherSensorDoes) {
  const auto ties = tiesWhenFoundAgain({});
  ASSERT_EQ(ties.size(), 2u);
  EXPECT_TRUE(ties[0].link);
  EXPECT_GT(ties[0].t_a, 5);
  EXPECT_FALSE(ties[1].link);
  EXPECT_LT(ties[1].t_a, 5);
  const auto with_wheels = tiesWhenFoundAgain({.previous_from_current = Pose3::Identity()});
  ASSERT_EQ(with_wheels.size(), 1u);
  EXPECT_FALSE(with_wheels[0].link);
}

}  // namespace
}  // namespace roomgraph::tracking
