// SPDX-License-Identifier: BSD-3-Clause
// Visual loop closing in a rendered room, and verification of proposed closures.
#include <gtest/gtest.h>

#include "feature_odometry.h"
#include "place_recognition.h"
#include "roomgraph/core/config.h"
#include "papered_wall.h"
#include "textured_room.h"

namespace roomgraph {
namespace {

Pose3 looking(double yaw) {
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({0, yaw, 0});
  pose.translation() << 0.3 * std::sin(yaw), 0, 0.3 * std::cos(yaw);
  return pose;
}

TEST(Thumbnail, IsMostSimilarToItself) {
  const test::TexturedRoom room;
  const auto a = tracking::makeThumbnail(room.render(0, looking(0)).gray);
  const auto b = tracking::makeThumbnail(room.render(0, looking(1.5)).gray);
  EXPECT_NEAR(tracking::similarity(a, a), 1, 1e-5);
  EXPECT_LT(tracking::similarity(a, b), 0.7);
}

TEST(LoopClosing, FullTurnClosesALoopWithTheTrueRelativePose) {
  const test::TexturedRoom room;
  FeatureOdometry odometry;
  Config::fromText("[tracking]\nloop_min_gap = 8\n").read("tracking", odometry);
  std::vector<RelativePose> closures;
  const double step = 0.13;
  for (int i = 0; i < 54; ++i) {
    ASSERT_TRUE(odometry.track(room.render(i, looking(step * i)), {}).tracked) << i;
    for (const auto& closure : odometry.takeLoopClosures()) closures.push_back(closure);
  }
  ASSERT_FALSE(closures.empty());
  for (const auto& closure : closures) {
    EXPECT_GT(closure.t_b - closure.t_a, 8);
    EXPECT_EQ(closure.source, "tracking");
    EXPECT_GE(closure.covariance(0, 0), 0.02 * 0.02) << "floors: 2 cm and 0.01 rad";
    EXPECT_GE(closure.covariance(4, 4), 0.01 * 0.01);
    const Pose3 expected = looking(step * closure.t_a).inverse() * looking(step * closure.t_b);
    EXPECT_LT((expected.inverse() * closure.a_from_b).translation().norm(), 0.02);
    EXPECT_LT(rotationAngle(expected.inverse() * closure.a_from_b), 0.01);
  }
}

TEST(LoopClosing, AProposedClosureIsConfirmedByTheImagesOrNot) {
  const test::TexturedRoom room;
  FeatureOdometry odometry;
  const double step = 0.13;
  for (int i = 0; i < 49; ++i)
    ASSERT_TRUE(odometry.track(room.render(i, looking(step * i)), {}).tracked) << i;
  RelativePose proposed;
  proposed.t_a = 0;
  proposed.t_b = 48;  // a full turn later
  const auto closure = odometry.verifyLoop(proposed);
  ASSERT_TRUE(closure);
  EXPECT_LT(closure->t_a, 4);
  EXPECT_GT(closure->t_b, 44);
  const Pose3 expected = looking(step * closure->t_a).inverse() * looking(step * closure->t_b);
  EXPECT_LT((expected.inverse() * closure->a_from_b).translation().norm(), 0.02);
  EXPECT_LT(rotationAngle(expected.inverse() * closure->a_from_b), 0.01);
  proposed.t_b = 24;  // looks the other way
  EXPECT_FALSE(odometry.verifyLoop(proposed));
}

// A full turn. In some frames the image's lower part is blank, and what stands there as near as .6 m if `solid`.
bool closesAfterATurn(int first_blank, int last_blank, bool solid) {
  const test::TexturedRoom room;
  FeatureOdometry odometry;
  for (int i = 0; i < 49; ++i) {
    Frame frame = room.render(i, looking(0.13 * i));
    if (i >= first_blank && i <= last_blank) {
      const int top = frame.gray.rows * 55 / 100;
      const cv::Rect lower(0, top, frame.gray.cols, frame.gray.rows - top);
      frame.gray(lower).setTo(128);
      if (solid) frame.depth(lower).setTo(0.6);
    }
    EXPECT_TRUE(odometry.track(frame, {}).tracked) << i;
  }
  return odometry.verifyLoop({0, 48}).has_value();
}

// The same features, but what is there now would have hidden what was seen: another place.
TEST(LoopClosing, AViewWhoseWallsStandInFreeSpaceClosesNoLoop) {
  EXPECT_TRUE(closesAfterATurn(42, 48, false));
  EXPECT_FALSE(closesAfterATurn(42, 48, true));
}

// Nor does one that came shortly after such a view.
TEST(LoopClosing, ViewsAroundItHaveAVote) {
  EXPECT_TRUE(closesAfterATurn(43, 45, false));
  EXPECT_FALSE(closesAfterATurn(43, 45, true));
}

// A full turn; from the second half on the camera is higher, or rolls. On a robot, or in a hand.
bool closesOnAnotherHeight(double higher_m, double roll_rad, bool on_robot) {
  const test::TexturedRoom room;
  FeatureOdometry odometry;
  for (int i = 0; i < 49; ++i) {
    const double share = std::min(1.0, i / 40.0);
    const Pose3 camera = looking(0.13 * i) * poseFromYpr(0, -share * higher_m, 0, share * roll_rad, 0, 0);
    Frame frame = room.render(i, camera);
    if (on_robot) {
      frame.robot_from_camera.linear() = bodyFromOptical();
      frame.robot_from_camera.translation().z() = 1;
    }
    EXPECT_TRUE(odometry.track(frame, {}).tracked) << i;
  }
  return odometry.verifyLoop({0, 48}).has_value();
}

// Whoever would have left the floor to see a place so was not there.
TEST(LoopClosing, ARobotIsOnItsFloorWhereItWasBefore) {
  EXPECT_TRUE(closesOnAnotherHeight(0.05, 0.05, true));
  EXPECT_TRUE(closesOnAnotherHeight(0.25, 0, false));
  EXPECT_FALSE(closesOnAnotherHeight(0.25, 0, true));
  EXPECT_TRUE(closesOnAnotherHeight(0, 0.15, false));
  EXPECT_FALSE(closesOnAnotherHeight(0, 0.15, true));
}

// Past a wall of random paper that repeats itself, and back: how far from there the last view would fit as well.
double rivalAlongAWall(double period_m) {
  const test::PaperedWall wall(period_m);
  FeatureOdometry odometry;
  constexpr int kThere = 40;
  for (int i = 0; i <= 2 * kThere; ++i) {
    Pose3 pose = Pose3::Identity();
    pose.translation().x() = 0.1 * (i <= kThere ? i : 2 * kThere - i);
    EXPECT_TRUE(odometry.track(wall.render(0.2 * i, pose), {}).tracked) << i;
  }
  const auto closure = odometry.verifyLoop({0, 0.2 * 2 * kThere});
  EXPECT_TRUE(closure);
  return closure ? closure->rival_m : 0;
}

// Carried back over a pause of which nobody tells: the closure that ties the view to where it is found.
double rivalOfAViewFoundAgain(double period_m) {
  const test::PaperedWall wall(period_m);
  FeatureOdometry odometry;
  for (int i = 0; i <= 40; ++i) {
    Pose3 pose = Pose3::Identity();
    pose.translation().x() = 0.1 * i;
    EXPECT_TRUE(odometry.track(wall.render(0.2 * i, pose), {}).tracked) << i;
  }
  odometry.takeLoopClosures();
  EXPECT_EQ(odometry.track(wall.render(8 + 2.3, Pose3::Identity()), {}).reason, "found again in another place");
  const auto closures = odometry.takeLoopClosures();
  EXPECT_EQ(closures.size(), 1u);
  return closures.empty() ? 0 : closures[0].rival_m;
}

TEST(LoopClosing, WhereAPaperRepeatsItselfAViewFoundAgainHasARival) {
  EXPECT_LT(rivalOfAViewFoundAgain(1.7), 4);
  EXPECT_EQ(rivalOfAViewFoundAgain(100), std::numeric_limits<double>::infinity());
}

TEST(LoopClosing, WhereAPaperRepeatsItselfAClosureHasARival) {
  EXPECT_NEAR(rivalAlongAWall(1.7), 1.7, 0.05);
  EXPECT_NEAR(rivalAlongAWall(2.9), 2.9, 0.05);
  EXPECT_EQ(rivalAlongAWall(100), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace roomgraph
