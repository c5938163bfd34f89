// SPDX-License-Identifier: BSD-3-Clause
// Values made ahead: the order, the end and the failures of calls one after the other.
#include "roomgraph/core/read_ahead.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <vector>

namespace roomgraph::test {
namespace {

using namespace std::chrono_literals;

std::vector<int> drained(ReadAhead<int>& ahead) {
  std::vector<int> out;
  while (const auto value = ahead.next()) out.push_back(*value);
  return out;
}

class ReadAheadOf : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ReadAheadOf, GivesWhatCallsOneAfterTheOtherGive) {
  int made = 0;
  ReadAhead<int> ahead(
      [&]() -> std::optional<int> { return made < 500 ? std::optional(made++) : std::nullopt; }, GetParam());
  const auto all = drained(ahead);
  ASSERT_EQ(all.size(), 500u);
  for (int i = 0; i < 500; ++i) EXPECT_EQ(all[static_cast<std::size_t>(i)], i);
  EXPECT_FALSE(ahead.next()) << "and it stays at the end";
}

TEST_P(ReadAheadOf, AFailureComesInItsTurn) {
  int made = 0;
  ReadAhead<int> ahead(
      [&]() -> std::optional<int> {
        if (made == 3) throw std::runtime_error("cannot be read");
        return made++;
      },
      GetParam());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(ahead.next(), i);
  EXPECT_THROW(ahead.next(), std::runtime_error);
}

TEST_P(ReadAheadOf, MovesWhatCannotBeCopied) {
  bool made = false;
  ReadAhead<std::unique_ptr<int>> ahead(
      [&]() -> std::optional<std::unique_ptr<int>> {
        if (std::exchange(made, true)) return std::nullopt;
        return std::make_unique<int>(7);
      },
      GetParam());
  EXPECT_EQ(**ahead.next(), 7);
  EXPECT_FALSE(ahead.next());
}

INSTANTIATE_TEST_SUITE_P(Capacity, ReadAheadOf, ::testing::Values(0, 1, 8));

TEST(ReadAhead, IsNoFartherAheadThanItMay) {
  std::atomic<int> made = 0;
  ReadAhead<int> ahead([&]() -> std::optional<int> { return made++; }, 4);
  for (int i = 0; i < 2000 && made < 4; ++i) std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(made, 4);
  EXPECT_EQ(ahead.next(), 0);
  for (int i = 0; i < 2000 && made < 5; ++i) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(made, 5);
}

TEST(ReadAhead, EndsWithWhoeverDoesNotWantMore) {
  for (int wanted = 0; wanted < 20; ++wanted) {
    int made = 0;
    ReadAhead<int> ahead([&]() -> std::optional<int> { return made++; }, 3);
    for (int i = 0; i < wanted; ++i) EXPECT_EQ(ahead.next(), i);
  }
}

TEST(Foreseen, IsTakenByTimeAndDropsWhatIsOver) {
  Foreseen<int> foreseen;
  EXPECT_FALSE(foreseen.take(1));
  for (const double t : {1.0, 2.0, 4.0}) foreseen.put(t, static_cast<int>(10 * t));
  EXPECT_EQ(foreseen.take(2), 20);
  EXPECT_FALSE(foreseen.take(3)) << "never put";
  EXPECT_EQ(foreseen.take(4), 40);
  EXPECT_FALSE(foreseen.take(4)) << "once";
}

}  // namespace
}  // namespace roomgraph::test
