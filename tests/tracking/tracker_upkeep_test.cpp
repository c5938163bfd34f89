// SPDX-License-Identifier: BSD-3-Clause
// Keyframes given up in a room that is seen again and again: how many stay, and what still works with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "textured_room.h"
#include "tracker.h"

namespace roomgraph::tracking {
namespace {

constexpr int kFramesPerTurn = 49, kTurns = 5;
constexpr double kStep_rad = 2 * std::numbers::pi / kFramesPerTurn;
constexpr int kRecent = 40;  // keyframes that are never given up
constexpr int kUnlimited = 100000;

Pose3 lookingAt(double frame) {
  const double yaw = kStep_rad * frame;
  Pose3 pose = Pose3::Identity();
  pose.linear() = expSO3({0, yaw, 0});
  pose.translation() << 0.3 * std::sin(yaw), 0, 0.3 * std::cos(yaw);
  return pose;
}

std::vector<Frame> turnIn(unsigned room_seed, double aside_m) {
  const test::TexturedRoom room(room_seed);
  std::vector<Frame> out;
  for (int i = 0; i < kFramesPerTurn; ++i) {
    Pose3 camera = lookingAt(i);
    camera.translation().x() += aside_m;
    out.push_back(room.render(i, camera));
  }
  return out;
}

enum Place { kMiddle, kAside, kOtherWalls };

/// A camera that turns in the middle of a room, aside from there, or in a room whose walls show something else.
struct TurningCamera {
  explicit TurningCamera(int keyframes_kept) : tracker(parametersWith(keyframes_kept)) {}

  static TrackingParameters parametersWith(int keyframes_kept) {
    TrackingParameters out;
    out.loop_min_gap = 8;
    out.max_features = 400;
    out.keyframes_kept = keyframes_kept;
    return out;
  }

  void turn(int turns, Place place = kMiddle) {
    static const std::array<std::vector<Frame>, 3> places{turnIn(1, 0), turnIn(1, 0.6), turnIn(5, 0)};
    for (int k = 0; k < turns * kFramesPerTurn; ++k) {
      Frame frame = places[place][static_cast<std::size_t>(frames % kFramesPerTurn)];
      frame.t = frames++;
      tracker.track(frame, {});
    }
  }

  Tracker tracker;
  int frames = 0;
};

/// Keyframes of a turn, as none is given up.
int keyframesOfATurn() {
  TurningCamera camera(kUnlimited);
  camera.turn(1);
  return camera.tracker.keyframesHeld();
}

void expectStepsOfTheTruth(const Trajectory& camera) {
  for (std::size_t i = 1; i < camera.size(); ++i) {
    ASSERT_EQ(camera.segment(i), 0) << i;
    const auto frame = static_cast<double>(i);
    const Pose3 step = camera.poses()[i - 1].pose.inverse() * camera.poses()[i].pose;
    const Pose3 error = (lookingAt(frame - 1).inverse() * lookingAt(frame)).inverse() * step;
    EXPECT_LT(error.translation().norm(), 0.015) << i;
    EXPECT_LT(rotationAngle(error), 0.008) << i;
  }
}

TEST(TrackerUpkeep, KeyframesGrowWithWhatIsSeenNotWithTime) {
  TurningCamera all(kUnlimited), few(20);
  all.turn(kTurns);
  few.turn(kTurns);
  const int of_a_turn = keyframesOfATurn();
  ASSERT_GT(all.tracker.keyframesHeld(), (kTurns - 1) * of_a_turn) << "each turn has keyframes of its own";
  EXPECT_LE(few.tracker.keyframesHeld(), of_a_turn + kRecent + 5);

  const Trajectory camera = few.tracker.trajectory();
  ASSERT_EQ(camera.size(), static_cast<std::size_t>(kTurns * kFramesPerTurn)) << "frames stay";
  expectStepsOfTheTruth(camera);
}

void expectKeyframesOfBothPlaces(Place second) {
  TurningCamera few(20);
  few.turn(3);
  few.turn(kTurns, second);
  const int of_a_turn = keyframesOfATurn();
  EXPECT_GE(few.tracker.keyframesHeld(), 2 * of_a_turn + kRecent - 3);
  EXPECT_LE(few.tracker.keyframesHeld(), 2 * of_a_turn + kRecent + 8);
}

TEST(TrackerUpkeep, OtherWallsAreNotWhatWasSeenBefore) {
  expectKeyframesOfBothPlaces(kOtherWalls);
}

TEST(TrackerUpkeep, TheSameWallsFromElsewhereAreSomethingNew) {
  expectKeyframesOfBothPlaces(kAside);
}

TEST(TrackerUpkeep, AsManyAsAreAllowedStay) {
  constexpr int kAllowed = 65;
  TurningCamera all(kUnlimited), limited(kAllowed);
  all.turn(kTurns);
  limited.turn(kTurns);
  ASSERT_GT(all.tracker.keyframesHeld(), kAllowed);
  EXPECT_EQ(limited.tracker.keyframesHeld(), kAllowed);
}

void expectTrue(const RelativePose& closure) {
  const Pose3 expected = lookingAt(closure.t_a).inverse() * lookingAt(closure.t_b);
  EXPECT_LT((expected.inverse() * closure.a_from_b).translation().norm(), 0.02);
}

TEST(TrackerUpkeep, LoopsCloseWithTheKeyframesThatStay) {
  TurningCamera few(20);
  few.turn(kTurns);
  few.tracker.takeLoopClosures();
  few.turn(1);
  const auto closures = few.tracker.takeLoopClosures();
  const auto of_first_turn = [](const RelativePose& closure) { return closure.t_a < kFramesPerTurn; };
  EXPECT_TRUE(std::any_of(closures.begin(), closures.end(), of_first_turn)) << "older than all that are recent";
  for (const auto& closure : closures) expectTrue(closure);
}

TEST(TrackerUpkeep, AClosureIsConfirmedByWhatShowsTheSameAsAKeyframeGivenUp) {
  TurningCamera few(20);
  few.turn(kTurns);
  RelativePose proposed;
  proposed.t_a = 1.5 * kFramesPerTurn;  // given up by now
  proposed.t_b = few.frames - 0.5 * kFramesPerTurn;
  const auto closure = few.tracker.verifyLoop(proposed);
  ASSERT_TRUE(closure);
  EXPECT_LT(closure->t_a, kFramesPerTurn);
  EXPECT_NEAR(closure->t_b, proposed.t_b, 3);
  expectTrue(*closure);
}

TEST(TrackerUpkeep, ALostCameraIsFoundAmongTheKeyframesThatStay) {
  TurningCamera few(20);
  few.turn(kTurns);
  const test::TexturedRoom room;
  for (int i = 0; i < 8; ++i) {
    Frame blank = room.render(few.frames++, lookingAt(0));
    blank.gray.setTo(128);
    blank.depth.setTo(0);
    EXPECT_FALSE(few.tracker.track(blank, {}).tracked);
  }
  few.tracker.takeLoopClosures();
  const auto found = few.tracker.track(room.render(few.frames, lookingAt(0.4 * kFramesPerTurn)), {});
  EXPECT_TRUE(found.tracked);
  const auto closures = few.tracker.takeLoopClosures();
  ASSERT_EQ(closures.size(), 1u);
  EXPECT_EQ(closures[0].t_b, few.frames);
  const int seen_then = static_cast<int>(closures[0].t_a);
  EXPECT_LT(rotationAngle(closures[0].a_from_b.inverse() * lookingAt(seen_then).inverse() * lookingAt(0.4 * kFramesPerTurn)), 0.02);
}

}  // namespace
}  // namespace roomgraph::tracking
