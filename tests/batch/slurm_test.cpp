// SPDX-License-Identifier: BSD-3-Clause
// Batches on a real Slurm: many runs, and whatever dies on the way.
#include <chrono>
#include <thread>

#include "slurm_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr const char* kOne = "  - name: default\n";
constexpr const char* kTwo = "  - name: default\n  - {name: no_lidar, set: lidar.enabled=false}\n";

TEST_F(SlurmBatch, TwentyRunsGiveWhatThisMachineGives) {
  for (int i = 0; i < 10; ++i) makeRecording("r" + std::to_string(i), 6);
  const auto ended = batch(words(slurmJobs(kTwo)));
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("20 runs done, 0 unchanged, 0 failed, 0 left"));
  EXPECT_EQ(submitted(ended.err), 20u) << ended.err;
  expectAllComplete(20);
  EXPECT_FALSE(std::filesystem::exists(folder.file("out/slurm/000001"))) << "what is over leaves nothing";
  const auto local = batch({"data/r3.rawlog", "-o", "local", "--keep", "summary"});
  ASSERT_EQ(local.exit_code, 0) << local.err;
  const auto here = readRunResult(folder.file("local/runs/r3--default/result.json")),
             there = result("r3--default");
  EXPECT_EQ(here.key, there.key);
  EXPECT_EQ(here.figures.at("counts.key_poses"), there.figures.at("counts.key_poses"));
  EXPECT_THAT(batch(words(slurmJobs(kTwo))).out, HasSubstr("0 runs done, 20 unchanged"));
  EXPECT_THAT(batch({"jobs.yaml", "-o", "out"}).out, HasSubstr("20 unchanged")) << "whatever engine";
}

TEST_F(SlurmBatch, AKilledBatchFindsItsJobs) {
  makeRecordings({"a", "b", "c", "d", "e", "f"}, 6);
  said("scontrol update NodeName=node0 State=DRAIN Reason=test");
  Program first = started(words(slurmJobs(kOne)));
  const std::string noted = folder.file("out/slurm/000001/job");
  ASSERT_TRUE(waitUntil([&] { return active().size() == 6 && std::filesystem::exists(noted); }));
  kill(first.pid(), SIGKILL);
  first.wait();
  expectOneLine(batch({"jobs.yaml", "-o", "out"}), 2, HasSubstr("jobs of this batch are in a queue"));
  // As if it had been killed before it read the answer of sbatch.
  ASSERT_TRUE(std::filesystem::remove(noted));
  Program second = started(words("jobs.yaml"));
  ASSERT_TRUE(waitUntil([this] {
    return contentOf(folder.file("stderr.txt")).find("found     f--default") != std::string::npos;
  }));
  said("scontrol update NodeName=node0 State=RESUME");
  const auto ended = second.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err, Not(HasSubstr("submitted ")));
  expectAllComplete(6);
}

TEST_F(SlurmBatch, WhatEndsWhileNobodyWatchesIsTakenIn) {
  makeRecording("a");
  makeRecording("b", 9);
  Program first = started(words(slurmJobs(kOne)));
  ASSERT_TRUE(waitUntil([] { return !active().empty(); }));
  kill(first.pid(), SIGKILL);
  first.wait();
  ASSERT_TRUE(waitUntil([] { return active().empty(); }));
  const auto ended = batch(words("jobs.yaml"));
  EXPECT_THAT(ended.out, HasSubstr("0 runs done, 2 unchanged")) << ended.err;
  expectAllComplete(2);
}

TEST_F(SlurmBatch, WhatHasChangedMeanwhileIsDoneAnew) {
  makeRecording("a");
  said("scontrol update NodeName=node0 State=DRAIN Reason=test");
  Program first = started(words(slurmJobs(kOne)));
  ASSERT_TRUE(waitUntil([] { return active().size() == 1; }));
  kill(first.pid(), SIGKILL);
  first.wait();
  const auto job = active();
  makeRecording("a", 10);
  Program second = started(words("jobs.yaml"));
  ASSERT_TRUE(waitUntil([&] { return active().size() == 1 && active() != job; }));
  said("scontrol update NodeName=node0 State=RESUME");
  const auto ended = second.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("cancel    a--default"));
  EXPECT_EQ(result("a--default").figures.at("counts.scans"), 10);
}

TEST_F(SlurmBatch, CancelledJobsHaveFailed) {
  makeRecordings({"a", "b", "c", "d"}, 60);
  options = ", cpus: 2";
  Program program = started(words(slurmJobs(kOne, "limits: {threads: 1, retries: 0}\n")));
  ASSERT_TRUE(waitUntil([] { return countOf("RUNNING") == 2 && countOf("PENDING") == 2; }));
  ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  const std::string job = active().front().substr(0, active().front().find('_'));
  said("scancel " + job + "_0 " + job + "_3");  // one that runs, one that waits
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 1) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("2 runs done, 0 unchanged, 2 failed"));
  for (const char* run : {"a--default", "d--default"}) {
    EXPECT_EQ(result(run).status, "failed");
    EXPECT_EQ(result(run).reason, "its job was cancelled");
    EXPECT_THAT(result(run).failures, SizeIs(1));
  }
  EXPECT_TRUE(std::filesystem::exists(runFolder("a--default") / "summary.json")) << "what it had is written";
  const auto again = batch(words("jobs.yaml"));
  EXPECT_THAT(again.out, HasSubstr("2 runs done, 2 unchanged")) << again.err;
}

TEST_F(SlurmBatch, ANodeThatFailsCostsAnAttempt) {
  makeRecording("a", 100);
  makeRecording("b", 8);
  Program program = started(words(slurmJobs(kOne, "limits: {retries: 1}\n")));
  ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  slurm->tell("crash-node");
  EXPECT_TRUE(waitUntil([this] { return tasks("run").empty(); }));
  slurm->tell("start-node");
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("again     a--default: its node failed"));
  expectAllComplete(2);
  ASSERT_THAT(result("a--default").failures, SizeIs(1));
  EXPECT_EQ(result("a--default").failures[0].reason, "its node failed");
}

TEST_F(SlurmBatch, ANodeDaemonThatIsKilledCostsNothing) {
  makeRecording("a", 60);
  Program program = started(words(slurmJobs(kOne)));
  ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  slurm->tell("kill-node");
  slurm->tell("start-node");
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(result("a--default").failures, IsEmpty());
  EXPECT_EQ(submitted(ended.err), 1u);
}

TEST_F(SlurmBatch, ARequeuedJobIsSeenTwice) {
  makeRecording("a", 60);
  options = ", options: [--requeue]";
  Program program = started(words(slurmJobs(kOne, "limits: {retries: 1}\n")));
  ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  const std::string task = active().front().substr(0, active().front().find(' '));
  said("scontrol requeue " + task);
  ASSERT_TRUE(waitUntil([] { return countOf("PENDING") == 1; }));
  // Slurm does not launch a job in the second in which it has revoked its credential.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  said("scontrol update StartTime=now JobId=" + task);  // it would wait for two minutes
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(submitted(ended.err), 1u);
  expectAllComplete(1);
  ASSERT_THAT(result("a--default").failures, SizeIs(1));
  EXPECT_THAT(result("a--default").failures[0].reason, HasSubstr("the queue began it again"));
}

TEST_F(SlurmBatch, CtrlCCancelsTheJobs) {
  makeRecordings({"a", "b", "c"}, 60);
  options = ", cpus: 4";
  Program program = started(words(slurmJobs(kOne)));
  ASSERT_TRUE(waitUntil([] { return countOf("RUNNING") == 1; }));
  ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(runFolder("a--default") / "progress"); }));
  kill(program.pid(), SIGINT);
  const auto ended = program.wait();
  EXPECT_EQ(ended.exit_code, 4) << ended.err;
  EXPECT_THAT(ended.err, AllOf(HasSubstr("interrupted: the jobs are cancelled"), HasSubstr("3 runs left")));
  EXPECT_THAT(active(), IsEmpty());
  EXPECT_EQ(result("a--default").status, "interrupted");
  EXPECT_FALSE(std::filesystem::exists(runFolder("c--default") / "result.json"));
}

TEST_F(SlurmBatch, AClosedTerminalLeavesThem) {
  makeRecordings({"a", "b"}, 20);
  said("scontrol update NodeName=node0 State=DRAIN Reason=test");
  Program program = started(words(slurmJobs(kOne)));
  ASSERT_TRUE(waitUntil([] { return active().size() == 2; }));
  kill(program.pid(), SIGHUP);
  const auto left = program.wait();
  EXPECT_EQ(left.exit_code, 4);
  EXPECT_THAT(left.err, HasSubstr("2 tasks go on in the queue"));
  EXPECT_THAT(active(), SizeIs(2));
  said("scontrol update NodeName=node0 State=RESUME");
  const auto ended = batch(words("jobs.yaml"));
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(submitted(ended.err), 0u);
  expectAllComplete(2);
}

TEST_F(SlurmBatch, PiecesGoSideBySide) {
  makeRecording("a", 60);
  auto split = words(slurmJobs(kOne));
  split.insert(split.end(), {"--split", "3 s", "--overlap", "1 s"});
  const auto ended = batch(split);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(submitted(ended.err), 4u) << "one that measures, two pieces, one that joins them";
  expectAllComplete(3);
}

TEST_F(SlurmBatch, WrongSettingsEndTheBatch) {
  makeRecording("a");
  options = ", partition: nosuch";
  const auto refused = batch(words(slurmJobs(kOne)));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(linesOf(refused.err).back(),
              AllOf(HasSubstr("sbatch refuses: "), HasSubstr("nvalid partition")));
  options = ", account: lab";
  expectOneLine(batch(words(slurmJobs(kOne))), 2, HasSubstr("slurm"));
  options = ", options: [account=lab]";
  expectOneLine(batch(words(slurmJobs(kOne))), 2, HasSubstr("write it like --account=lab"));
  options.clear();
  const auto plan = batch({slurmJobs(kOne), "-o", "dry", "--engine", "slurm", "--dry-run"});
  EXPECT_THAT(plan.out, AllOf(HasSubstr("run       a--default (new)"), HasSubstr("#SBATCH --array=0-0\n"),
                              HasSubstr("#SBATCH --mem=200M")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("dry")));
  const auto none = call(folder.path(), {"batch", "jobs.yaml", "-o", "none", "--engine", "slurm"},
                         folder.path(), {"PATH=/nowhere"});
  expectOneLine(none, 2, HasSubstr("sbatch is no command here"));
}

/// A queue that takes five jobs.
class SmallQueue : public SlurmBatch {
 protected:
  static void SetUpTestSuite() { slurm = std::make_unique<SlurmHere>("CPUS=4 MaxJobCount=5 MinJobAge=2"); }
};

TEST_F(SmallQueue, WhatItDoesNotTakeNowItTakesLater) {
  for (int i = 0; i < 12; ++i) makeRecording("r" + std::to_string(i), 4);
  const auto ended = batch(words(slurmJobs(kOne)));
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err,
              HasSubstr("waits     the queue takes no more now (sbatch: error: Slurm temporarily unable"));
  EXPECT_EQ(submitted(ended.err), 12u);
  expectAllComplete(12);
}

}  // namespace
}  // namespace roomgraph::test
