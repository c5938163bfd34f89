// SPDX-License-Identifier: BSD-3-Clause
// What is learnt of a robot on wheels, and of one that also drives sideways.
#include "movement_habits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "feature_odometry.h"
#include "textured_room.h"

namespace roomgraph::tracking {
namespace {

constexpr double kSeconds = 0.25;

// An arc of a circle: its end, as the robot at its beginning sees it.
Pose3 arc(double length_m, double yaw) {
  const double chord = std::abs(yaw) < 1e-9 ? length_m : 2 * length_m / yaw * std::sin(yaw / 2);
  return poseFromYpr(chord * std::cos(yaw / 2), chord * std::sin(yaw / 2), 0, yaw, 0, 0);
}

// Arcs that were measured with normal errors.
MovementHabits driven(int count, double sideways_m, double error_m, double error_rad) {
  MovementHabits out;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) {
    const Pose3 moved = arc(0.2 + 0.02 * normal(random), 0.6 * normal(random));
    const Pose3 error = poseFromYpr(error_m * normal(random), sideways_m * normal(random) + error_m * normal(random),
                                    error_m * normal(random), error_rad * normal(random), error_rad * normal(random),
                                    error_rad * normal(random));
    out.learn(moved * error, kSeconds);
  }
  return out;
}

TEST(MovementHabits, OfWheelsTheErrorsOfMeasuringAreLearnt) {
  const auto scatter = driven(60, 0, 0.003, 0.002).scatter();
  const double root = std::sqrt(kSeconds);
  for (const int translation : {1, 2}) EXPECT_NEAR(scatter[translation], 0.003 / root, 0.0025) << translation;
  for (const int rotation : {3, 4}) EXPECT_NEAR(scatter[rotation], 0.002 / root, 0.0015) << rotation;
  EXPECT_TRUE(std::isinf(scatter[0]) && std::isinf(scatter[5])) << "ahead, and turns";
}

TEST(MovementHabits, ArcsAreNoSidewaysMovementWhateverTheTurn) {
  const auto scatter = driven(60, 0, 0, 0).scatter();
  EXPECT_LT(scatter.segment<4>(1).maxCoeff(), 1e-9);
}

TEST(MovementHabits, WhoDrivesSidewaysMayGoOnDoingSo) {
  const MovementHabits habits = driven(60, 0.1, 0.003, 0.002);
  EXPECT_GT(habits.scatter()[1], 0.1);
  const Pose3 sideways = poseFromYpr(0.05, 0.08, 0.01, 0.1, 0.02, -0.03), expected = habits.expected(sideways);
  EXPECT_EQ(expected.translation(), Eigen::Vector3d(0.05, 0.08, 0));
  const Eigen::Vector3d turn = logSO3(sideways.linear());
  EXPECT_LT((logSO3(expected.linear()) - Eigen::Vector3d(0, 0, turn.z())).norm(), 1e-12);
}

// Now and then is often enough.
TEST(MovementHabits, WhoDrivesSidewaysOneTimeInFiveMayDoSo) {
  MovementHabits habits;
  for (int i = 0; i < 60; ++i) habits.learn(i % 5 == 0 ? poseFromYpr(0, 0.15, 0, 0, 0, 0) : arc(0.2, 0.1), kSeconds);
  EXPECT_GT(habits.scatter()[1], 0.1);
  EXPECT_EQ(habits.expected(poseFromYpr(0, 0.05, 0, 0, 0, 0)).translation().y(), 0.05);
}

TEST(MovementHabits, OfWheelsAnArcIsExpected) {
  const Pose3 expected = driven(60, 0, 0.003, 0.002).expected(poseFromYpr(0.1, -0.06, 0.02, 0.4, 0.05, -0.02));
  EXPECT_NEAR(expected.translation().x(), 0.1, 1e-12);
  EXPECT_NEAR(expected.translation().y(), 0.1 * std::tan(logSO3(expected.linear()).z() / 2), 1e-12);
  EXPECT_EQ(expected.translation().z(), 0);
  EXPECT_NEAR(logSO3(expected.linear()).z(), 0.4, 0.01);
}

TEST(MovementHabits, UntilEnoughIsLearntItIsOnWheels) {
  const Pose3 anything = poseFromYpr(0.1, 0.2, 0.3, 0.1, 0.2, 0.3);
  const MovementHabits few = driven(11, 0.1, 0.1, 0.1), enough = driven(12, 0.1, 0.1, 0.1);
  EXPECT_EQ(few.scatter().segment<4>(1).norm(), 0);
  EXPECT_EQ(few.expected(anything).translation().z(), 0);
  EXPECT_GT(enough.scatter().segment<4>(1).minCoeff(), 0.05);
  EXPECT_LT((enough.expected(anything).translation() - anything.translation()).norm(), 1e-12);
}

// Where a frame of nothing is said to be after a camera moved to the right and ahead, 2 cm a frame each, on a robot or in a
// hand; before that it may have gone to and fro sideways for a while.
Eigen::Vector3d goesOn(bool on_robot, int to_and_fro) {
  const test::TexturedRoom room;
  FeatureOdometry odometry;
  Eigen::Vector3d place(0, 0, 0);
  int t = 0;
  const auto track = [&](bool visible) {
    Pose3 camera = Pose3::Identity();
    camera.translation() = place;
    Frame frame = room.render(t++, camera);
    if (!visible) frame.gray.setTo(128), frame.depth.setTo(0);
    if (on_robot) {
      frame.robot_from_camera.linear() = bodyFromOptical();
      frame.robot_from_camera.translation() << 0.2, 0, 1;
    }
    const TrackingResult result = odometry.track(frame, {});
    EXPECT_EQ(result.tracked, visible) << t;
    return result.odom_from_camera;
  };
  track(true);
  for (int i = 0; i < to_and_fro; ++i)
    for (const double step : {0.06, 0.06, 0.06, -0.06, -0.06, -0.06}) {
      place.x() += step;
      track(true);
    }
  Pose3 last = Pose3::Identity();
  for (int i = 0; i < 4; ++i) {
    place += Eigen::Vector3d(0.02, 0, 0.02);
    last = track(true);
  }
  return (last.inverse() * track(false)).translation();
}

TEST(Tracker, AVelocityGoesOnAsTheRobotsHabitsAre) {
  const Eigen::Vector3d by_hand = goesOn(false, 0), on_wheels = goesOn(true, 0), strafing = goesOn(true, 8);
  EXPECT_LT((by_hand - Eigen::Vector3d(0.02, 0, 0.02)).norm(), 0.008);
  EXPECT_LT((on_wheels - Eigen::Vector3d(0, 0, 0.02)).norm(), 0.008);
  EXPECT_LT((strafing - Eigen::Vector3d(0.02, 0, 0.02)).norm(), 0.008);
}

TEST(MovementHabits, ChangeWithWhatWasSeenLately) {
  MovementHabits habits = driven(60, 0.1, 0.003, 0.002);
  for (int i = 0; i < 60; ++i) habits.learn(arc(0.2, 0.1), kSeconds);
  EXPECT_LT(habits.scatter()[1], 1e-9);
  habits.learn(arc(0.2, 0.1), 0);  // takes no time: nothing to learn
  EXPECT_TRUE(habits.scatter().segment<4>(1).allFinite());
}

}  // namespace
}  // namespace roomgraph::tracking
