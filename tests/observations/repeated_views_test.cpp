// SPDX-License-Identifier: BSD-3-Clause
// Which views of a drive round and round are given up.
#include "roomgraph/observations/repeated_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace roomgraph {
namespace {

constexpr double kLap_s = 60;

// A circle of 2 m, a lap a minute, the robot looking ahead.
Pose3 onCircle(double t) {
  const double angle = 2 * M_PI * t / kLap_s;
  return poseFromYpr(2 * std::cos(angle), 2 * std::sin(angle), 0, angle + M_PI / 2, 0, 0);
}

std::vector<double> timesOf(double duration_s, double step_s = 0.5) {
  std::vector<double> out;
  for (double t = 0; t <= duration_s; t += step_s) out.push_back(t);
  return out;
}

Trajectory drive(double duration_s) {
  Trajectory out;
  for (const double t : timesOf(duration_s, 0.25)) out.add(t, onCircle(t));
  return out;
}

std::vector<double> keptOf(std::vector<double> times, const Trajectory& drive, const ViewLimits& limits) {
  eraseAt(times, repeatedViews(times, drive, limits));
  return times;
}

TEST(RepeatedViews, WhatIsKeptGrowsWithTheAreaNotWithTime) {
  const Trajectory way = drive(40 * kLap_s);
  const ViewLimits limits{.of_a_view = 4};
  const auto ten = keptOf(timesOf(10 * kLap_s), way, limits), forty = keptOf(timesOf(40 * kLap_s), way, limits);
  EXPECT_LT(ten.size(), timesOf(10 * kLap_s).size() / 4);
  EXPECT_EQ(ten.size(), forty.size());
}

TEST(RepeatedViews, NoPlaceLosesItsViewsAndTheyAreSpreadOverTime) {
  const Trajectory way = drive(40 * kLap_s);
  const auto kept = keptOf(timesOf(40 * kLap_s), way, {.of_a_view = 4});
  std::map<int, std::set<double>> laps_of_part;  // of the circle, in 12 parts
  for (const double t : kept) {
    const double in_lap = std::fmod(t, kLap_s);
    laps_of_part[static_cast<int>(in_lap / kLap_s * 12)].insert(std::floor(t / kLap_s));
  }
  ASSERT_EQ(laps_of_part.size(), 12u);
  for (const auto& [part, laps] : laps_of_part) {
    EXPECT_LT(*laps.begin(), 2) << part;
    EXPECT_GT(*laps.rbegin(), 37) << part;
    EXPECT_GE(laps.size(), 4u) << part;
  }
}

TEST(RepeatedViews, ASmallCellKeepsExactlyItsMost) {
  Trajectory standing;
  for (int t = 0; t <= 100; ++t) standing.add(t, Pose3::Identity());
  const auto kept = keptOf(timesOf(100, 1), standing, {.of_a_view = 5});
  ASSERT_EQ(kept.size(), 5u);
  EXPECT_EQ(kept.front(), 0);
  EXPECT_EQ(kept.back(), 100);
  for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_GT(kept[i] - kept[i - 1], 10);
  EXPECT_EQ(keptOf(timesOf(4, 1), standing, {.of_a_view = 5}), timesOf(4, 1));
}

TEST(RepeatedViews, OtherDirectionsAndPlacesAreOtherViews) {
  Trajectory way;
  for (int t = 0; t < 12; ++t) way.add(t, poseFromYpr(t % 2 ? 1.0 : 0.0, 0, 0, t % 4 < 2 ? 0 : 1.0, 0, 0));
  EXPECT_EQ(keptOf(timesOf(11, 1), way, {.of_a_view = 2}).size(), 8u);  // of four views that come three times each
}

TEST(RepeatedViews, WhereTheRobotWasNotKnownNothingIsGivenUp) {
  Trajectory way;
  for (int t = 0; t <= 10; ++t) way.add(t, Pose3::Identity());
  const auto kept = keptOf(timesOf(100, 1), way, {.of_a_view = 2});
  EXPECT_EQ(kept.size(), 92u);  // 2 of 11, and all of the 90 after them
}

TEST(RepeatedViews, LimitsThatAreNoneAreRefused) {
  for (const ViewLimits& limits : {ViewLimits{.of_a_view = 1}, ViewLimits{.place_m = 0}, ViewLimits{.direction_rad = -1}})
    EXPECT_THROW(repeatedViews({}, {}, limits), std::invalid_argument);
}

TEST(GivingUp, IsDoneAgainWhenAQuarterHasCome) {
  struct View {
    double t;
  };
  Trajectory standing;
  for (int t = 0; t <= 1000; ++t) standing.add(t, Pose3::Identity());
  std::vector<View> views;
  GrowthWatch watch;
  std::size_t most = 0;
  for (int t = 0; t <= 1000; ++t) {
    views.push_back({static_cast<double>(t)});
    giveUpRepeated(views, watch, 100, standing, [](const View& view) { return view.t; }, {.of_a_view = 40});
    most = std::max(most, views.size());
    EXPECT_TRUE(t >= 100 || views.size() == static_cast<std::size_t>(t) + 1) << t;
  }
  EXPECT_EQ(most, 100u);  // the one above was looked through at once
  EXPECT_GE(views.size(), 40u);
}

TEST(GrowthWatch, WaitsForAQuarterAbove) {
  GrowthWatch watch;
  EXPECT_FALSE(watch.due(100, 100));
  EXPECT_TRUE(watch.due(101, 100));
  watch.done(100);
  EXPECT_FALSE(watch.due(125, 100));
  EXPECT_TRUE(watch.due(126, 100));
}

}  // namespace
}  // namespace roomgraph
