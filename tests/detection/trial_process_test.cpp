// SPDX-License-Identifier: BSD-3-Clause
// Work in a process of its own: each end it can come to.
#include "trial_process.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <vector>

#include "memory_limit.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

TEST(TrialProcess, WorkThatEndsLeavesNothingBehind) {
  int value = 1;
  EXPECT_EQ(fateOfTrial([&] { value = 2; }), "");
  EXPECT_EQ(value, 1) << "was another process";
  EXPECT_EQ(fateOfTrial([] { throw std::runtime_error("an answer, too"); }), "");
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no child is left";
}

TEST(TrialProcess, ACrashIsTold) {
  for (const int signal : {SIGSEGV, SIGFPE, SIGABRT, SIGKILL})
    EXPECT_THAT(fateOfTrial([&] { std::raise(signal); }),
                HasSubstr("ended by signal " + std::to_string(signal) + " ("));
  EXPECT_EQ(fateOfTrial([] { _exit(7); }), "ended with exit code 7");
}

TEST(TrialProcess, WhatGoesOnForeverIsEnded) {
  volatile bool forever = true;
  EXPECT_EQ(fateOfTrial(
                [&] {
                  while (forever) continue;
                },
                {.cpu_s = 1}),
            "needed more than 1 s of processor time");
}

TEST(TrialProcess, WhatWaitsForeverIsEnded) {
  EXPECT_EQ(fateOfTrial([] { sleep(100); }, {.wall_s = 1}), "did not come to an end within 1 s");
}

// Those of this process are not in the other one.
TEST(TrialProcess, OpenCvHasOneThreadThereAndAsManyAsBeforeHere) {
  const int before = cv::getNumThreads();
  cv::setNumThreads(4);
  const auto sum = [] {
    std::atomic<int> all = 0;
    cv::parallel_for_({0, 1000}, [&all](const cv::Range& range) { all += range.size(); });
    if (all != 1000) std::abort();
  };
  for (int round = 0; round < 20; ++round) {
    sum();
    EXPECT_EQ(fateOfTrial([&] { cv::getNumThreads() == 1 ? sum() : std::abort(); }, {.wall_s = 20}), "");
    EXPECT_EQ(cv::getNumThreads(), 4);
  }
  cv::setNumThreads(before);
}

TEST(TrialProcess, MemoryIsLimited) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "not under this sanitizer";
  const auto needs = [](std::size_t bytes) {
    return [bytes] {
      void* memory = std::malloc(bytes);
      if (!memory) std::abort();
      std::free(memory);
    };
  };
  EXPECT_EQ(fateOfTrial(needs(std::size_t{1} << 30)), "");
  EXPECT_THAT(fateOfTrial(needs(std::size_t{5} << 30)), HasSubstr("signal 6"));
}

}  // namespace
}  // namespace roomgraph
