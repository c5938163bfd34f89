// SPDX-License-Identifier: BSD-3-Clause
// Bags in which clocks are set back: where it is found, and that all records come in the order of reception.
#include <gmock/gmock.h>

#include "bag_maker.h"
#include "clock_watch.h"
#include "continued_clock.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using bags::ClockWatch;
using bags::ContinuedClock;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

/// Topics of ten messages a second, all watched.
class Watched {
 public:
  explicit Watched(std::size_t topics, std::size_t deciding = 9) : deciding_(deciding), counts_(topics) {}
  Watched& message(std::size_t topic, double t_s) {
    watch_.take(std::to_string(topic), std::llround(1e9 * t_s), topic < deciding_, counts_);
    ++counts_[topic];
    return *this;
  }
  /// `back_s`: of each topic.
  Watched& frames(double from_s, int count, const std::vector<double>& back_s) {
    for (int k = 0; k < count; ++k)
      for (std::size_t i = 0; i < back_s.size(); ++i) message(i, from_s + 0.1 * k - back_s[i]);
    return *this;
  }
  const std::vector<bags::ClockRestart>& restarts() {
    watch_.finish();
    return watch_.restarts();
  }

 private:
  std::size_t deciding_;
  ClockWatch watch_;
  std::vector<std::uint64_t> counts_;
};

TEST(ClockWatch, FindsTheFirstMessageBehindTheFall) {
  Watched bag(2);
  const auto& found = bag.frames(100, 10, {0, 0}).frames(101, 30, {2, 2}).restarts();
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].before, ElementsAre(10, 10));
  EXPECT_NEAR(1e-9 * static_cast<double>(found[0].back_ns), 2, 1e-6);
  Watched twice(1);
  EXPECT_THAT(twice.frames(100, 10, {0}).frames(101, 10, {30}).frames(102, 10, {60}).restarts(), SizeIs(2));
}

TEST(ClockWatch, WhatWasMeasuredBeforeTheFallMayComeBehindIt) {
  Watched bag(2);
  bag.frames(100, 10, {0, 0}).message(0, 99).message(1, 101).message(0, 99.1);
  EXPECT_THAT(bag.frames(101.2, 10, {2, 2}).restarts(), SizeIs(1));
}

TEST(ClockWatch, SingleWrongTimesAreNoRestart) {
  Watched bag(2);
  bag.frames(100, 10, {0, 0}).message(0, 3).frames(101, 10, {0, 0});
  bag.message(1, 5000).frames(102, 10, {0, 0}).message(0, 4);
  EXPECT_THAT(bag.restarts(), IsEmpty());
  Watched alone(1);
  EXPECT_THAT(alone.frames(100, 10, {0}).message(0, 3).frames(101, 10, {0}).restarts(), IsEmpty());
}

TEST(ClockWatch, OneTopicOfSeveralIsNoRestart) {
  Watched bag(3);
  EXPECT_THAT(bag.frames(100, 10, {0, 0, 0}).frames(101, 30, {0, 20, 0}).restarts(), IsEmpty());
  Watched late(2);
  EXPECT_THAT(late.frames(100, 10, {0, 0}).frames(101, 10, {0.9, 0.9}).restarts(), IsEmpty())
      << "less than a second";
}

TEST(ClockWatch, TransformsOfOtherComputersDoNotDecide) {
  Watched bag(2, 1);
  const auto& found = bag.frames(100, 10, {0, 0}).message(1, 99).frames(101, 30, {2, 0}).restarts();
  ASSERT_THAT(found, SizeIs(1)) << "what stays on another clock";
  EXPECT_THAT(found[0].before, ElementsAre(10, 10)) << "but may be the first to fall";
  Watched alone(2, 1);
  EXPECT_THAT(alone.frames(100, 10, {0, 0}).frames(101, 30, {0, 5}).restarts(), IsEmpty());
}

TEST(ContinuedClock, StampsGoOnAndStragglersStayWithTheirPart) {
  ContinuedClock clock({{{2, 1}, 30'000'000'000}}, {{{2, 1}, 30'000'000'000}});
  const auto follow = [&](std::size_t topic, double received_s, double stamp_s) {
    clock.follow(topic, std::llround(1e9 * received_s));
    return clock.partOf(topic == 0 ? "wheels" : "eye", std::llround(1e9 * stamp_s));
  };
  EXPECT_EQ(follow(0, 100, 100), 0u);
  EXPECT_EQ(follow(1, 100, 99.95), 0u);
  EXPECT_EQ(follow(0, 100.1, 100.1), 0u);
  EXPECT_EQ(follow(0, 70.2, 70.2), 1u);
  EXPECT_EQ(clock.receivedNs(), 100'200'000'000);
  EXPECT_EQ(follow(1, 70.2, 100.05), 0u) << "taken before, received behind";
  EXPECT_EQ(follow(1, 70.3, 70.15), 1u);
  EXPECT_EQ(clock.addedNs(1), 30'000'000'000);
  EXPECT_GT(clock.apartNs(1), clock.addedNs(1) + 1'000'000'000);
  EXPECT_EQ(clock.apartNs(0), 0);
}

/// All records by kind, each time by its frame; `back_s` from frame 11 on.
void expectFramesInOrder(const Imported& bag, double back_s) {
  const auto expect = [&](const auto& records, double offset_s) {
    ASSERT_THAT(records, SizeIs(20));
    for (int k = 0; k < 20; ++k)
      EXPECT_NEAR(secondsOf(*records[static_cast<std::size_t>(k)]),
                  kStart_s + 0.1 * k + offset_s - (k > 10 ? back_s : 0), 1e-6)
          << k;
  };
  expect(only<mrpt::obs::CObservation3DRangeScan>(bag.records), 0);
  expect(only<mrpt::obs::CObservation2DRangeScan>(bag.records), 0.008);
  expect(only<mrpt::obs::CObservationOdometry>(bag.records), 0);
  std::vector<double> falls;
  for (std::size_t i = 1; i < bag.records.size(); ++i)
    if (const double step = secondsOf(*bag.records[i]) - secondsOf(*bag.records[i - 1]); step < 0)
      falls.push_back(step);
  EXPECT_THAT(falls, SizeIs(1)) << "nothing is merged over the jump";
}

class EverySetBack : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(EverySetBack, AllRecordsComeInTheOrderOfReception) {
  const auto& [json, back_s] = GetParam();
  const Imported bag(json);
  EXPECT_THAT(bag.result.warnings, Contains(HasSubstr("clocks: they are set back by")));
  EXPECT_THAT(bag.result.skipped,
              ElementsAre(Pair("ground truth: behind the place where the clocks are set back", 9)));
  expectFramesInOrder(bag, back_s);
  const auto images = only<mrpt::obs::CObservation3DRangeScan>(bag.records);
  for (std::size_t k = 0; k < images.size(); ++k) {
    ASSERT_TRUE(images[k]->hasRangeImage);
    EXPECT_NEAR(images[k]->rangeImage(5, 9) * images[k]->rangeUnits, 1.09 + 0.001 * static_cast<double>(k),
                1e-6)
        << "of its own colour image";
    EXPECT_NEAR(images[k]->sensorPose.pitch(), k < 10 ? 0 : 10 * std::numbers::pi / 180, 1e-6)
        << "by the transforms of its part";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bags, EverySetBack,
    ::testing::Values(std::pair(R"({"back": 1.5, "extrinsics": "moving"})", 1.5),
                      std::pair(R"({"back": 30, "extrinsics": "moving"})", 30.),
                      std::pair(R"({"back": 30, "extrinsics": "moving", "odometry": false})", 30.),
                      std::pair(R"({"back": 30, "extrinsics": "moving", "back_received": false})", 30.)));

TEST(ClocksSetBack, WithTimesOfReceptionTheRestStillComes) {
  const Imported bag(R"({"back": 30, "stamps": false})");
  EXPECT_THAT(only<mrpt::obs::CObservation3DRangeScan>(bag.records), SizeIs(20));
  EXPECT_THAT(only<mrpt::obs::CObservation2DRangeScan>(bag.records), SizeIs(20));
}

}  // namespace
}  // namespace roomgraph
