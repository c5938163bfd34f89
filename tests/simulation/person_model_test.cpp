// SPDX-License-Identifier: BSD-3-Clause
// Simulated persons: gait symmetry, seat and scale of the body; waiting, corners and laps of the walk.
#include "person_model.h"

#include <gtest/gtest.h>

#include <numbers>

namespace roomgraph {
namespace {

constexpr double kTurn = std::numbers::pi;

Mesh bodyOf(const PersonModel& model, const PersonState& state) {
  Mesh all;
  const auto poses = model.pose(state);
  for (std::size_t i = 0; i < poses.size(); ++i) all.append(model.parts()[i].moved(poses[i]));
  return all;
}

TEST(PersonModel, HalfACycleLaterLeftAndRightAreExchanged) {
  Person person;
  person.path_m = {{0, 0}};
  MaterialList materials;
  const PersonModel model(person, materials);
  const Eigen::DiagonalMatrix<double, 3> mirror(1, -1, 1);
  for (const double phase : {0.3, 1.9, 4.0}) {
    const auto now = model.pose({{}, phase, true}), later = model.pose({{}, phase + kTurn, true});
    ASSERT_EQ(now.size(), 9u);
    for (std::size_t i = 1; i <= 4; ++i) {  // right thigh, shank, upper arm and forearm; the left ones are four on
      const Pose3 &right = now[i], &left = later[i + 4];
      EXPECT_LT((mirror * right.translation() - left.translation()).norm(), 1e-12) << i;
      EXPECT_LT((mirror * right.linear() * mirror - left.linear()).norm(), 1e-12) << i;
    }
    // Arm and leg of one side swing against each other.
    const auto forward = [&](std::size_t i) { return -now[i].linear().col(2).x(); };
    EXPECT_LT(forward(1) * (forward(3) - forward(7)), 0) << phase;
  }
}

TEST(PersonModel, TheFeetStayOnTheFloorWhileWalking) {
  Person person;
  person.path_m = {{0, 0}};
  MaterialList materials;
  const PersonModel model(person, materials);
  for (double phase = 0; phase < 2 * kTurn; phase += 0.2) {
    const auto box = bodyOf(model, {{}, phase, true}).bounds();
    EXPECT_NEAR(box.min().z(), 0, 0.06) << phase;
    EXPECT_NEAR(box.max().z(), person.height_m, 0.06) << phase;
  }
}

TEST(PersonModel, ASeatedPersonHasTheHipsAboveTheSeatAndTheFeetBelow) {
  Person person;
  person.path_m = {{0, 0}};
  person.sits = true;
  MaterialList materials;
  for (const double seat : {0.4, 0.5}) {
    person.seat_height_m = seat;
    const PersonModel model(person, materials);
    const auto poses = model.pose({});
    EXPECT_NEAR(poses[0].translation().z(), seat + 0.09, 1e-9);
    const Eigen::Vector3d knee = poses[2].translation(), hip = poses[1].translation();
    EXPECT_GT(knee.x() - hip.x(), 0.4) << "thighs point forward";
    EXPECT_NEAR(knee.z(), hip.z(), 0.05);
    EXPECT_LT(bodyOf(model, {}).bounds().min().z(), 0.12);
  }
}

TEST(PersonModel, TheBodyScalesWithItsHeight) {
  Person tall, small;
  tall.path_m = small.path_m = {{0, 0}};
  tall.height_m = 1.75;
  small.height_m = 1.4;
  MaterialList materials;
  const PersonState state{{}, 0.7, true};
  const auto a = bodyOf(PersonModel(tall, materials), state).bounds(),
             b = bodyOf(PersonModel(small, materials), state).bounds();
  EXPECT_LT((b.min() - 0.8 * a.min()).norm(), 1e-5);
  EXPECT_LT((b.max() - 0.8 * a.max()).norm(), 1e-5);
}

TEST(PersonWalk, WaitsUntilItsStartAndStaysWithoutAPath) {
  Person person;
  person.path_m = {{0, 0}, {4, 0}};
  person.speed_m_s = 1;
  person.start_s = 3;
  const PersonWalk walk(person);
  for (const double t : {0.0, 2.9, 3.0}) {
    EXPECT_FALSE(walk.at(t).walks) << t;
    EXPECT_NEAR(walk.at(t).pose.x, walk.at(0).pose.x, 1e-12);
  }
  EXPECT_TRUE(walk.at(3.1).walks);
  EXPECT_NEAR(walk.at(5).pose.x, 2, 1e-9);
  Person stays;
  stays.path_m = {{1, 2}};
  stays.yaw_rad = 0.7;
  const auto state = PersonWalk(stays).at(50);
  EXPECT_EQ(state.pose.x, 1);
  EXPECT_EQ(state.pose.y, 2);
  EXPECT_EQ(state.pose.yaw, 0.7);
  EXPECT_FALSE(state.walks);
}

TEST(PersonWalk, RepeatsItsLapsAndCutsCornersALittle) {
  Person person;
  person.path_m = {{0, 0}, {3, 0}, {3, 2}};
  person.speed_m_s = 0.5;
  const PersonWalk walk(person);
  const double lap = 2 * (5 / 0.5 + 1.5);  // 5 m and a turn of 1.5 s, there and back
  for (double t = 0; t < lap; t += 0.37) {
    const auto a = walk.at(t).pose, b = walk.at(t + 2 * lap).pose;
    EXPECT_NEAR(a.x, b.x, 1e-9) << t;
    EXPECT_NEAR(a.y, b.y, 1e-9) << t;
    const double off = std::min(a.x <= 3 ? std::abs(a.y) : 9.0, std::abs(a.x - 3));
    EXPECT_LT(off, 0.1) << t;
  }
  EXPECT_NEAR(walk.at(8).pose.yaw, kTurn / 2, 1e-9) << "along +y on the second leg";
  EXPECT_NEAR(std::abs(wrapAngle(walk.at(8 + 10).pose.yaw - kTurn)), 0, 1e-9) << "back along -x";
  // Two steps a stride of 1.3 m.
  EXPECT_NEAR(walk.at(4).phase, 2 * kTurn * 2 / 1.3, 1e-9);
}

}  // namespace
}  // namespace roomgraph
