// SPDX-License-Identifier: BSD-3-Clause
// Offsets between clocks: those put in, with honest deviations, whatever else the sensors err by.
#include "roomgraph/estimation/clock_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "timed_paths.h"

namespace roomgraph::test {
namespace {

std::optional<TimeOffset> offsetOf(const Trajectory& sensor, const Trajectory& reference) {
  ClockComparison comparison;
  EXPECT_FALSE(comparison.compare(sensor, reference));
  return comparison.offset();
}

TEST(ClockComparison, FindsHowLateASensorIs) {
  const Drive drive(60, 1);
  const Trajectory reference = seenBy(drive, {}, 2);
  for (const double late : {-0.6, -0.1, 0.0, 0.03, 0.12, 0.5}) {
    const auto found = offsetOf(seenBy(drive, {.rate_hz = 15, .late_s = alwaysLate(late)}, 3), reference);
    ASSERT_TRUE(found) << late;
    EXPECT_NEAR(found->seconds, -late, 0.006);
    EXPECT_LT(found->sigma, 0.01);
  }
}

// What sensors do: records seldom, wheels that turn too far, noise that is ten times larger.
TEST(ClockComparison, StatesWhatItMayBeOffBy) {
  double sum = 0;
  int found = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Drive drive(60, seed);
    Random random(100 + seed);
    const double late = random.uniform(-0.3, 0.3), noise = std::exp(random.uniform(std::log(5e-4), std::log(8e-3)));
    const Trajectory reference = seenBy(drive, {.rate_hz = random.uniform(5, 20)}, 200 + seed);
    const Trajectory sensor =
        seenBy(drive, {.rate_hz = random.uniform(5, 50), .noise_rad = noise, .noise_m = noise, .late_s = alwaysLate(late)}, 300 + seed);
    const auto offset = offsetOf(sensor, reference);
    if (!offset) continue;
    ++found;
    sum += std::pow((offset->seconds + late) / offset->sigma, 2);
  }
  EXPECT_GE(found, 28);
  EXPECT_GT(sum / found, 0.02);
  EXPECT_LT(sum / found, 1.5);
}

TEST(ClockComparison, RestAndSteadyDrivingSayNothing) {
  Trajectory a, b, still;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.1 * i;
    a.add(t, toPose3(Pose2{0.3 * t, 0, 0}));
    b.add(t + 0.2, toPose3(Pose2{0.3 * t, 0, 0}));
    still.add(t, Pose3::Identity());
  }
  EXPECT_FALSE(offsetOf(a, b));
  EXPECT_FALSE(offsetOf(still, still));
  EXPECT_FALSE(offsetOf(a, Trajectory()));
  EXPECT_FALSE(offsetOf(Trajectory(), a));
}

// A robot that stood for long and turned once is not known better for that.
TEST(ClockComparison, RestIsNoEvidence) {
  Trajectory sensor, reference;
  Random random(14);
  double yaw = 0;
  for (int i = 0; i < 700; ++i) {
    const double t = 0.1 * i;
    if (t > 62 && t < 64) yaw += 0.08;
    sensor.add(t, toPose3(Pose2{0, 0, yaw + 0.001 * random.normal()}));
    reference.add(t, toPose3(Pose2{0, 0, yaw + 0.001 * random.normal()}));
  }
  EXPECT_FALSE(offsetOf(sensor, reference));
}

// Six movements in a hundred are measured wrong.
TEST(ClockComparison, SlipsCountLittle) {
  const Drive drive(90, 4);
  const Trajectory reference = seenBy(drive, {}, 5), sensor = seenBy(drive, {.late_s = alwaysLate(0.1)}, 6);
  Random random(7);
  Trajectory slipping;
  Pose2 at;
  for (std::size_t i = 0; i < sensor.size(); ++i) {
    if (i > 0) at = at * (planarPart(sensor.poses()[i - 1].pose).inverse() * planarPart(sensor.poses()[i].pose));
    if (random.uniform(0, 1) < 0.06) at = at * Pose2{random.uniform(-0.3, 0.3), 0, random.uniform(-0.3, 0.3)};
    slipping.add(sensor.poses()[i].t, toPose3(at));
  }
  const auto found = offsetOf(slipping, reference);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->seconds, -0.1, 0.01);
}

TEST(ClockComparison, AClockThatJumpsIsForgottenUpToThen) {
  const Drive drive(120, 8);
  const Trajectory reference = seenBy(drive, {}, 9);
  const Trajectory sensor = seenBy(drive, {.late_s = [](double t) { return t < 80 ? 0.02 : 0.42; }}, 10);
  ClockComparison comparison;
  Trajectory so_far, reference_so_far;
  double jumped_t = 0, before = 0;
  for (std::size_t i = 0, j = 0; i < sensor.size(); ++i) {
    so_far.add(sensor.poses()[i].t, sensor.poses()[i].pose);
    for (; j < reference.size() && reference.poses()[j].t <= so_far.lastTime(); ++j)
      reference_so_far.add(reference.poses()[j].t, reference.poses()[j].pose);
    if (so_far.lastTime() < 80 && comparison.offset()) before = comparison.offset()->seconds;
    if (comparison.compare(so_far, reference_so_far)) {
      EXPECT_EQ(jumped_t, 0) << "once";
      jumped_t = so_far.lastTime();
    }
  }
  EXPECT_NEAR(before, -0.02, 0.006);
  EXPECT_GT(jumped_t, 80);
  EXPECT_LT(jumped_t, 100);
  ASSERT_TRUE(comparison.offset());
  EXPECT_NEAR(comparison.offset()->seconds, -0.42, 0.006);
  comparison.forget();
  EXPECT_FALSE(comparison.offset());
}

// Whether they come one by one or all at once.
TEST(ClockComparison, WhatIsSeenLaterIsComparedLater) {
  const Drive drive(40, 11);
  const Trajectory reference = seenBy(drive, {}, 12), sensor = seenBy(drive, {.rate_hz = 15, .late_s = alwaysLate(0.05)}, 13);
  ClockComparison at_once, one_by_one;
  at_once.compare(sensor, reference);
  Trajectory so_far;
  for (std::size_t i = 0; i < sensor.size(); ++i) {
    so_far.add(sensor.poses()[i].t, sensor.poses()[i].pose);
    one_by_one.compare(so_far, reference);
  }
  ASSERT_TRUE(at_once.offset() && one_by_one.offset());
  EXPECT_EQ(*at_once.offset(), *one_by_one.offset());
}

}  // namespace
}  // namespace roomgraph::test
