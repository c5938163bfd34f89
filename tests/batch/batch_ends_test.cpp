// SPDX-License-Identifier: BSD-3-Clause
// Batches that are killed, interrupted, or not alone.
#include <fcntl.h>
#include <sys/file.h>

#include <csignal>
#include <random>

#include "child_process.h"
#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class BatchEnds : public SmallBatch {
 protected:
  void SetUp() override {
    SmallBatch::SetUp();
    for (const char* name : {"a", "b", "c"}) makeRecording(name, 12);
  }
  double progressOf(const std::string& run) const {
    double share = 0;
    std::ifstream(runFolder(run) / "progress") >> share;
    return share;
  }
};

constexpr const char* kPlain = "  - name: default\n  - {name: no_lidar, set: lidar.enabled=false}\n";

TEST_F(BatchEnds, KilledAtAnyMomentTheSameCommandGoesOn) {
  ASSERT_EQ(batch({jobs(kPlain), "-o", "out", "--quiet"}).exit_code, 0);
  const auto undisturbed = results();
  ASSERT_EQ(undisturbed.size(), 30u);
  std::filesystem::remove_all(folder.file("out"));
  std::mt19937 random(7);
  for (int kills = 0; kills < 4; ++kills) {
    Program program = started({jobs(kPlain), "-o", "out", "--quiet"});
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 700));
    kill(program.pid(), SIGKILL);
    program.wait();
    EXPECT_TRUE(waitUntil([&] { return tasks().empty(); }, 5)) << "its children die with it";
  }
  const auto last = batch({jobs(kPlain), "-o", "out", "--quiet"});
  EXPECT_EQ(last.exit_code, 0) << last.err;
  EXPECT_TRUE(results() == undisturbed);
  EXPECT_EQ(catalogued().size(), 6u);
  for (const auto& run : catalogued()) EXPECT_EQ(run.status, "complete") << run.name;
}

TEST_F(BatchEnds, AfterCtrlCTheSameCommandGoesOn) {
  for (const char* name : {"a", "b"}) makeRecording(name, 80);
  Program program = started({jobs(kPlain), "-o", "out", "--jobs", "2"});
  ASSERT_TRUE(waitUntil([&] { return tasks("run").size() >= 2; }));
  ASSERT_TRUE(waitUntil([&] { return progressOf("a--default") > 0.1; }));
  kill(program.pid(), SIGINT);
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 4) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("runs left; the same command again goes on"));
  EXPECT_TRUE(tasks().empty());
  const auto interrupted = result("a--default");
  EXPECT_EQ(interrupted.status, "interrupted");
  EXPECT_TRUE(std::filesystem::exists(runFolder("a--default") / "summary.json")) << "what it had is written";
  const auto again = batch({jobs(kPlain), "-o", "out"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("a--default (interrupted before: interrupted)"));
}

TEST_F(BatchEnds, TwiceCtrlCKills) {
  makeRecording("a", 80);
  Program program = started({jobs(), "-o", "out"});
  ASSERT_TRUE(waitUntil([&] { return !tasks("run").empty(); }));
  for (const pid_t task : tasks("batch-task")) kill(task, SIGSTOP);  // whoever does not listen
  kill(program.pid(), SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(program.pid(), SIGINT);
  EXPECT_EQ(program.wait().exit_code, -1);
  EXPECT_TRUE(waitUntil([&] { return tasks().empty(); }, 5));
}

// Some daemons ignore the ends of their children, and so does what they start.
TEST_F(BatchEnds, HowAChildEndedIsToldWhereTheEndsOfChildrenWereIgnored) {
  std::signal(SIGCHLD, SIG_IGN);
  ChildProcess fails({"/bin/sh", "-c", "exit 3"}, folder.file("log"), true);
  std::optional<ChildEnd> end;
  ASSERT_TRUE(waitUntil([&] { return (end = fails.ended()).has_value(); }));
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(end->exit_code, 3);
}

// A queue sends SIGTERM to all processes of a job, to some of them after their parent has told them by SIGINT.
TEST_F(BatchEnds, WhoWasToldByItsParentIgnoresTheQueueFromThenOnToo) {
  makeRecording("long", 400);
  ChildProcess run({ROOMGRAPH_PROGRAM, "run", folder.file("data/long.rawlog").string(), "-o",
                    folder.file("out").string(), "--no-report", "--no-snapshot"},
                   folder.file("log"), false);
  const auto live = folder.file("out/roomgraph_unfinished/live.tum");
  std::error_code none_yet;
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::file_size(live, none_yet) > 2000 && !none_yet; }));
  run.signal(SIGTERM);
  run.signal(SIGINT);
  std::optional<ChildEnd> end;
  ASSERT_TRUE(waitUntil([&] {
    if ((end = run.ended())) return true;
    run.signal(SIGTERM);
    return false;
  }));
  EXPECT_EQ(end->exit_code, 4) << folder.read("log");
  EXPECT_TRUE(std::filesystem::exists(folder.file("out/summary.json"))) << "what it had is written";
}

TEST_F(BatchEnds, ARunThatIsKilledIsTriedAgain) {
  makeRecording("a", 80);
  Program program = started({"data/a.rawlog", "-o", "out", "--retries", "1"});
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  for (const pid_t run : tasks("run")) kill(run, SIGKILL);
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("again     a--default: killed"));
  const auto run = result("a--default");
  EXPECT_EQ(run.status, "complete");
  ASSERT_EQ(run.failures.size(), 1u);
  EXPECT_EQ(run.failures[0].exit_code, 137);
  EXPECT_EQ(catalogued()[0].failed_attempts, 1);
}

TEST_F(BatchEnds, ATaskThatIsKilledHasFailed) {
  makeRecording("a", 80);
  Program program = started({"data/a.rawlog", "-o", "out"});
  ASSERT_TRUE(waitUntil([&] { return !tasks("run").empty(); }));
  for (const pid_t task : tasks("batch-task")) kill(task, SIGKILL);
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(result("a--default").reason, "ended by signal 9");
  EXPECT_EQ(batch({"data/a.rawlog", "-o", "out"}).exit_code, 0);
}

TEST_F(BatchEnds, TwoInOneFolderAreRefused) {
  std::filesystem::create_directories(folder.file("out/runs"));
  const int lock = open(folder.file("out/batch.lock").c_str(), O_WRONLY | O_CREAT, 0666);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  expectOneLine(batch({"data/a.rawlog", "-o", "out"}), 1, HasSubstr("another batch is at work in it"));
  expectOneLine(batch({"import", "out"}), 1, HasSubstr("another batch is at work in it"));
  close(lock);
}

}  // namespace
}  // namespace roomgraph::test
