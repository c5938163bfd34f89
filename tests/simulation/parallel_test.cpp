// SPDX-License-Identifier: BSD-3-Clause
// Loops and tasks on several threads: everything once, and done when waited for.
#include "parallel.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace roomgraph {
namespace {

TEST(Parallel, EveryIndexOnce) {
  std::vector<int> visits(1000, 0);
  parallelFor(std::size_t{3}, visits.size(), [&](std::size_t i) { ++visits[i]; });
  for (std::size_t i = 0; i < visits.size(); ++i) EXPECT_EQ(visits[i], i < 3 ? 0 : 1) << i;
  parallelFor(5, 5, [](int) { FAIL() << "an empty loop"; });
}

TEST(Parallel, WhatALoopThrowsReachesTheCaller) {
  EXPECT_THROW(parallelFor(0, 100, [](int i) { if (i == 57) throw std::runtime_error("57"); }), std::runtime_error);
}

TEST(Parallel, ATaskIsDoneOnceWaitedFor) {
  for (int round = 0; round < 50; ++round) {
    std::vector<int> numbers(1000);
    TaskBeside beside;
    beside.run([&] { std::iota(numbers.begin(), numbers.end(), round); });
    beside.wait();
    EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0), 1000 * round + 999 * 500);
  }
}

}  // namespace
}  // namespace roomgraph
