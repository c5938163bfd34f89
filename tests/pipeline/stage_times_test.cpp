// SPDX-License-Identifier: BSD-3-Clause
// StageTimes: wall-clock and processor time, totals.
#include "roomgraph/pipeline/stage_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "memory_limit.h"

namespace roomgraph::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

TEST(StageTimes, SleepTakesTimeButNoProcessor) {
  StageTimes times;
  times.startRecord(7.5);
  {
    const auto measured = times.measure("sleep");
    std::this_thread::sleep_for(milliseconds(30));
  }
  ASSERT_EQ(times.calls().size(), 1u);
  const auto& call = times.calls().front();
  EXPECT_EQ(call.t, 7.5);
  EXPECT_STREQ(call.stage, "sleep");
  EXPECT_GE(call.ms, 30);
  EXPECT_LT(call.cpu_ms, 20);
}

TEST(StageTimes, WorkTakesProcessorTime) {
  StageTimes times;
  {
    const auto measured = times.measure("work");
    const std::clock_t started = std::clock();
    while (std::clock() - started < CLOCKS_PER_SEC / 50) {
    }
  }
  EXPECT_GE(times.calls().front().cpu_ms, 19);
  EXPECT_GE(times.calls().front().ms, 0.9 * times.calls().front().cpu_ms) << "one thread";
}

// Pages count once they are written to.
TEST(StageTimes, MemoryIsWhatIsHeldWhenTheCallEnds) {
  StageTimes times;
  { const auto measured = times.measure("before"); }
  std::vector<char> held;
  {
    const auto measured = times.measure("after");
    held.assign(64 << 20, 1);
  }
  ASSERT_EQ(held.back(), 1);
  const double grown_mb = times.calls()[1].memory_mb - times.calls()[0].memory_mb;
  EXPECT_GE(grown_mb, 60);
  // A sanitizer keeps books of every byte.
  EXPECT_LE(grown_mb, kMemoryCanBeLimited ? 68 : 600);
}

TEST(StageTimes, TotalsAreThoseOfTheCalls) {
  StageTimes times;
  for (int i = 0; i < 3; ++i) {
    times.startRecord(i);
    const auto outer = times.measure("outer");
    const auto inner = times.measure("inner");
    std::this_thread::sleep_for(milliseconds(1 + 4 * i));
  }
  const auto totals = times.totals();
  ASSERT_EQ(totals.size(), 2u);
  double sum = 0, most = 0;
  for (const auto& call : times.calls()) {
    if (std::string(call.stage) != "inner") continue;
    sum += call.ms;
    most = std::max(most, call.ms);
  }
  EXPECT_EQ(totals.at("inner").calls, 3);
  EXPECT_DOUBLE_EQ(totals.at("inner").total_ms, sum);
  EXPECT_DOUBLE_EQ(totals.at("inner").max_ms, most);
  EXPECT_GE(totals.at("outer").total_ms, sum);
}

}  // namespace
}  // namespace roomgraph::test
