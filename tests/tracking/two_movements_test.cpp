// SPDX-License-Identifier: BSD-3-Clause
// Points of a room and of something that moves before the camera, in shares up to nine tenths of a view.
#include "two_movements.h"

#include <gtest/gtest.h>

#include <random>

#include "tracking_parameters.h"

namespace roomgraph::tracking {
namespace {

/// A view of still and moving points, and some that are matched wrongly.
struct TwoMovementsScene {
  PoseProblem problem{{640, 480, 520, 520, 319.5, 239.5, {}}, {}, {}};
  Pose3 truth = poseFromYpr(0.02, 0, -0.03, 0.01, 0.02, 0), predicted = truth;
  int still = 0, moving = 0;

  TwoMovementsScene(int still_points, int moving_points, const Eigen::Vector3d& moved, int wrong = 10) : still(still_points), moving(moving_points) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> across(-1.6, 1.6), far(1.5, 5), near(0.9, 1.3), aside(0, 0.7), anywhere(-30, 30);
    std::normal_distribution<double> noise(0, 0.5);
    const TrackingParameters parameters;
    for (int i = 0; i < still + moving + wrong; ++i) {
      const bool moves = i >= still && i < still + moving;
      const double z = moves ? near(random) : far(random);
      const Eigen::Vector3d point(moves ? aside(random) : 0.3 * z * across(random), 0.25 * z * across(random), z);
      const Eigen::Vector3d now = truth * (moves ? Eigen::Vector3d(point + moved) : point);
      Eigen::Vector2d pixel = problem.camera.project(now) + Eigen::Vector2d(noise(random), noise(random));
      if (i >= still + moving) pixel += Eigen::Vector2d(anywhere(random), anywhere(random));
      problem.points.push_back(point);
      problem.observations.push_back(makeObservation(pixel, 0, static_cast<float>(now.z()), parameters));
    }
  }
  std::optional<TwoMovements> told(bool seen_lately = false) const { return tellApart(problem, refinePose(problem, predicted), predicted, {.seen_lately = seen_lately}); }
  int movingAmong(const TwoMovements& two, int from, int until) const {
    return static_cast<int>(std::count(two.moving.begin() + from, two.moving.begin() + until, 1));
  }
};

const Eigen::Vector3d kWalk(0.06, 0, 0.02);  // in a tenth of a second

TEST(TwoMovements, TheOneNearerToThePredictionIsTheCameras) {
  for (const auto& [still, moving] : {std::pair(200, 60), {120, 180}, {60, 250}, {30, 270}}) {
    const TwoMovementsScene scene(still, moving, kWalk);
    const auto two = scene.told();
    ASSERT_TRUE(two) << still;
    const Pose3 error = two->camera.camera_from_world * scene.truth.inverse();
    EXPECT_LT(error.translation().norm(), 0.006) << still;
    EXPECT_LT(rotationAngle(error), 0.003) << still;
    EXPECT_LE(scene.movingAmong(*two, 0, still), still / 10);
    EXPECT_GE(scene.movingAmong(*two, still, still + moving), 9 * moving / 10);
  }
}

TEST(TwoMovements, APredictionThatIsOffByLittleTellsThemApart) {
  TwoMovementsScene scene(100, 200, kWalk);
  scene.predicted = poseFromYpr(0.003, -0.002, 0.003, 0.001, 0, 0.001) * scene.truth;
  const auto two = scene.told();
  ASSERT_TRUE(two);
  EXPECT_LT((two->camera.camera_from_world * scene.truth.inverse()).translation().norm(), 0.006);
}

TEST(TwoMovements, WrongMatchesAndSmallThingsAreNoMovement) {
  EXPECT_FALSE(TwoMovementsScene(200, 0, kWalk, 60).told());
  EXPECT_FALSE(TwoMovementsScene(200, 20, kWalk).told());
  EXPECT_TRUE(TwoMovementsScene(200, 20, kWalk).told(true));
  EXPECT_FALSE(TwoMovementsScene(200, 0, kWalk, 60).told(true));
  EXPECT_FALSE(TwoMovementsScene(200, 14, kWalk, 60).told(true)) << "among so many wrong ones";
}

TEST(TwoMovements, AVelocityNeedsMoreThatGoesOn) {
  for (const auto& [still, tells] : {std::pair(15, false), {60, true}}) {
    const TwoMovementsScene scene(still, 250, kWalk);
    EXPECT_EQ(tellApart(scene.problem, refinePose(scene.problem, scene.predicted), scene.predicted, {.measured = false}).has_value(), tells) << still;
    EXPECT_TRUE(scene.told()) << still;
  }
}

// The images are right: nothing agrees with what was predicted.
TEST(TwoMovements, WheelsThatSlipAreNoMovement) {
  for (const double slip_m : {0.03, 0.17}) {
    TwoMovementsScene scene(200, 0, kWalk);
    scene.predicted = poseFromYpr(0, 0, slip_m, 0, 0, 0) * scene.truth;
    EXPECT_FALSE(scene.told()) << slip_m;
  }
}

}  // namespace
}  // namespace roomgraph::tracking
