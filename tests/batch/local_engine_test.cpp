// SPDX-License-Identifier: BSD-3-Clause
// The engine of this machine: bounds, exit codes, interruption.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "roomgraph/batch/engine.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

class OnThisMachine : public ::testing::Test {
 protected:
  void start(Engine& engine, std::size_t id, const std::string& script, double memory_mb = 1) const {
    engine.start({id, {"/bin/sh", "-c", script}, folder.file("log"), memory_mb});
  }
  static std::vector<EndedTask> waitForOne(Engine& engine) {
    for (int i = 0; i < 500; ++i) {
      const auto ended = engine.ended();
      if (!ended.empty()) return ended;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "nothing ended";
    return {};
  }
  const TemporaryFolder folder;
};

TEST_F(OnThisMachine, ExitCodesAndOutputComeBack) {
  const auto engine = makeLocalEngine({.jobs = 1});
  start(*engine, 7, "echo out; echo err >&2; exit 5");
  const auto ended = waitForOne(*engine);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, 7u);
  EXPECT_EQ(ended[0].exit_code, 5);
  EXPECT_EQ(folder.read("log"), "out\nerr\n");
  start(*engine, 8, "kill -9 $$");
  EXPECT_EQ(waitForOne(*engine)[0].exit_code, 137);
  engine->start({9, {"/no/such/program"}, folder.file("log"), 1});
  EXPECT_EQ(waitForOne(*engine)[0].exit_code, 127);
}

TEST_F(OnThisMachine, NoMoreThanTheJobsRun) {
  const auto engine = makeLocalEngine({.jobs = 2});
  for (std::size_t id = 0; id < 2; ++id) {
    EXPECT_TRUE(engine->accepts(1));
    start(*engine, id, "sleep 5");
  }
  EXPECT_FALSE(engine->accepts(1));
}

TEST_F(OnThisMachine, NoMoreThanTheMemoryHolds) {
  const auto engine = makeLocalEngine({.jobs = 10, .memory_mb = 1000});
  EXPECT_TRUE(engine->accepts(5000)) << "one alone always runs";
  start(*engine, 1, "sleep 5", 600);
  EXPECT_FALSE(engine->accepts(500));
  EXPECT_TRUE(engine->accepts(300));
  start(*engine, 2, "sleep 5", 300);
  EXPECT_FALSE(engine->accepts(200));
  const auto unlimited = makeLocalEngine({.jobs = 10});
  start(*unlimited, 1, "sleep 5", 100);
  EXPECT_TRUE(unlimited->accepts(1));
  EXPECT_FALSE(unlimited->accepts(1e9)) << "more than any machine has";
}

TEST_F(OnThisMachine, AllAreToldToEnd) {
  const auto engine = makeLocalEngine({.jobs = 2});
  start(*engine, 1, "trap 'exit 4' INT; echo ready; while true; do sleep 0.05; done");
  while (folder.read("log").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  engine->interrupt();
  EXPECT_EQ(waitForOne(*engine)[0].exit_code, 4);
}

TEST_F(OnThisMachine, JobsAreCoresByThreads) {
  const int cores = jobsOf({.threads = 1});
  EXPECT_GE(cores, 1);
  EXPECT_EQ(jobsOf({.threads = 2}), std::max(1, cores / 2));
  EXPECT_EQ(jobsOf({.threads = 1000}), 1);
  EXPECT_EQ(jobsOf({.jobs = 17, .threads = 3}), 17);
}

}  // namespace
}  // namespace roomgraph::test
