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
  PriorOfMovements prior() const { return {.predicted = {predicted, 0.01, 0.005}}; }
  std::optional<TwoMovements> told(bool seen_lately = false) const {
    PriorOfMovements known = prior();
    known.seen_lately = seen_lately;
    return tellApart(problem, refinePose(problem, predicted), known);
  }
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
  for (const auto& [still, tells] : {std::pair(25, false), {60, true}}) {
    const TwoMovementsScene scene(still, 250, kWalk);
    PriorOfMovements velocity = scene.prior();
    velocity.measured = false;
    EXPECT_EQ(tellApart(scene.problem, refinePose(scene.problem, scene.predicted), velocity).has_value(), tells) << still;
    EXPECT_TRUE(scene.told()) << still;
  }
}

// Wheels that are lifted say that the camera stands, and so does what goes along with it.
TEST(TwoMovements, AFewThatGoAlongWithTheCameraDoNotHoldIt) {
  TwoMovementsScene scene(400, 25, kWalk, 0);
  const Pose3 stands = scene.truth;
  const Pose3 moved = poseFromYpr(0.05, 0, 0.02, 0.03, 0, 0) * stands;
  for (std::size_t i = 0; i < scene.problem.points.size(); ++i) {
    const Eigen::Vector3d now = (i < 400 ? moved : stands) * scene.problem.points[i];
    scene.problem.observations[i] = makeObservation(scene.problem.camera.project(now), 0, static_cast<float>(now.z()), TrackingParameters{});
  }
  EXPECT_FALSE(scene.told());
}

// A cupboard is pushed to the side before a wall that goes from near to far: a camera that moves to the other side and turns would see
// nearly the same, with all features to a pixel or two.
TEST(TwoMovements, OneMovementThatFitsBothIsNotTheCameras) {
  TwoMovementsScene scene(0, 0, kWalk, 0);
  scene.truth = scene.predicted = Pose3::Identity();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(-0.5, 0.5);
  std::normal_distribution<double> noise(0, 0.3);
  const Eigen::Vector3d pushed(-0.04, 0, 0);
  const int still = 150, all = 400;
  for (int i = 0; i < all; ++i) {
    const double u = across(random), v = across(random), z = i < still ? 2.6 / (1 - 0.6 * u) : 1.5;
    const Eigen::Vector3d point(z * u * (i < still ? 1.2 : 0.8), z * v, z), now = i < still ? point : Eigen::Vector3d(point + pushed);
    const Eigen::Vector2d pixel = scene.problem.camera.project(now) + Eigen::Vector2d(noise(random), noise(random));
    scene.problem.points.push_back(point);
    scene.problem.observations.push_back(makeObservation(pixel, i % 8, static_cast<float>(now.z()), TrackingParameters{}));
  }
  const PoseSolution one = refinePose(scene.problem, scene.predicted);
  ASSERT_GT(one.inliers, 300) << "what is to be told apart";
  const auto two = tellApart(scene.problem, one, scene.prior());
  ASSERT_TRUE(two);
  EXPECT_LT(two->camera.camera_from_world.translation().norm(), 0.005);
  EXPECT_EQ(scene.movingAmong(*two, 0, still), 0);
  EXPECT_GT(scene.movingAmong(*two, still, all), 100);
  EXPECT_EQ(std::count(two->camera.inlier.begin(), two->camera.inlier.end(), 1), two->camera.inliers);
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
