// SPDX-License-Identifier: BSD-3-Clause
// What an engine of a cluster is made of, without a cluster: words of Slurm, scripts, files of an array, the
// task on a node.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "roomgraph/batch/engine.h"
#include "roomgraph/core/errors.h"
#include "slurm_queue.h"
#include "slurm_script.h"
#include "task_array.h"
#include "temporary_folder.h"
#include "tool_call.h"

namespace roomgraph::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

TEST(SlurmWords, AQueueIsRead) {
  const auto queue = queueOf(
      "17|0|RUNNING|None\n17|12|PENDING|Resources\n18|N/A|RUNNING|None\n\n9|3|CANCELLED|None\n"
      "20|1|PENDING|ReqNodeNotAvail, UnavailableNodes:n1|n2\n");
  ASSERT_THAT(queue, SizeIs(4)) << "a job that is no array is none of ours";
  EXPECT_EQ(queue.at({"17", 12}).state, "PENDING");
  EXPECT_EQ(queue.at({"17", 12}).reason, "Resources");
  EXPECT_EQ(queue.at({"9", 3}).state, "CANCELLED");
  EXPECT_EQ(queue.at({"20", 1}).reason, "ReqNodeNotAvail, UnavailableNodes:n1|n2");
  EXPECT_THAT(queueOf(""), IsEmpty());
}

TEST(SlurmWords, StatesAreOfWhatGoesOnOrIsOver) {
  for (const char* state : {"PENDING", "RUNNING", "COMPLETING", "SUSPENDED", "REQUEUED", "REQUEUE_HOLD"})
    EXPECT_TRUE(isActive(state)) << state;
  for (const char* state :
       {"COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", ""})
    EXPECT_FALSE(isActive(state)) << state;
  EXPECT_EQ(endOfState("NODE_FAIL").reason, "its node failed");
  EXPECT_EQ(endOfState("OUT_OF_MEMORY").exit_code, 137)
      << "like a run that the system kills: more memory next time";
  EXPECT_THAT(endOfState("TIMEOUT").reason, testing::StartsWith("over its time limit")) << "not tried again";
  EXPECT_TRUE(endOfState("CANCELLED").by_queue);
  EXPECT_FALSE(endOfState("FAILED").by_queue) << "what failed says itself why";
  EXPECT_EQ(endOfState("").reason, "its job ended without a word");
}

TEST(SlurmWords, AFullQueueIsNoRefusal) {
  EXPECT_TRUE(
      isRefusedForNow("sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying"));
  EXPECT_TRUE(isRefusedForNow(
      "sbatch: error: AssocMaxSubmitJobLimit\nsbatch: error: Batch job submission failed: Job "
      "violates accounting/QOS policy (job submit limit, user's size and/or time limits)"));
  EXPECT_TRUE(isRefusedForNow(
      "sbatch: error: Batch job submission failed: Unable to contact slurm controller (connect failure)"));
  EXPECT_TRUE(isRefusedForNow("sbatch: error: Batch job submission failed: Invalid job array specification"));
  EXPECT_FALSE(isRefusedForNow("sbatch: error: invalid partition specified: nosuch"));
  EXPECT_FALSE(isRefusedForNow("sbatch: unrecognized option '--acount=x'"));
}

TEST(SlurmScript, SaysWhatTheJobFileSays) {
  JobFile jobs;
  jobs.limits.threads = 2;
  jobs.limits.time_s = 3600;
  jobs.slurm = {"long", 0, 0, 0, {"--account=lab", "--nice"}, {"module load mrpt"}, 10, 60};
  const auto script =
      slurmScript(jobs, {"roomgraph-7-ab", "/lab/it's here/slurm/000007", "/opt/room graph", 20, 610.2});
  EXPECT_EQ(
      script,
      "#!/bin/sh\n"
      "#SBATCH --job-name=roomgraph-7-ab\n"
      "#SBATCH --array=0-19\n"
      "#SBATCH --output=\"/lab/it's here/slurm/000007/%a.out\"\n"
      "#SBATCH --nodes=1 --ntasks=1 --cpus-per-task=2\n"
      "#SBATCH --mem=611M\n"
      "#SBATCH --time=76\n"
      "#SBATCH --partition=long\n"
      "#SBATCH --no-requeue\n"
      "#SBATCH --account=lab\n"
      "#SBATCH --nice\n"
      "module load mrpt\n"
      "exec '/opt/room graph' batch-element '/lab/it'\\''s here/slurm/000007' \"$SLURM_ARRAY_TASK_ID\"\n");
  jobs.slurm.time_s = 120;
  jobs.slurm.cpus = 8;
  EXPECT_THAT(slurmScript(jobs, {"x", "/x", "/p", 1, 100}),
              AllOf(HasSubstr("--time=2\n"), HasSubstr("--cpus-per-task=8\n"), HasSubstr("--array=0-0\n")));
  jobs.slurm.time_s = jobs.limits.time_s = 0;
  EXPECT_THAT(slurmScript(jobs, {"x", "/x", "/p", 1, 100}), Not(HasSubstr("--time")))
      << "the partition's own";
}

TEST(SlurmScript, MemoryIsAskedForInSteps) {
  SlurmSettings slurm;
  EXPECT_EQ(requestedMemory(slurm, 10, 1), 256);
  EXPECT_EQ(requestedMemory(slurm, 256, 1), 256);
  EXPECT_EQ(requestedMemory(slurm, 257, 1), 320);
  for (double expected = 300; expected < 1e5; expected *= 1.07) {
    const double asked = requestedMemory(slurm, expected, 1);
    EXPECT_GE(asked, expected * (1 - 1e-9));
    EXPECT_LE(asked, expected * 1.2500001);
    EXPECT_EQ(requestedMemory(slurm, asked, 1), asked) << "as much as it was told";
  }
  slurm.memory_mb = 2000;
  EXPECT_EQ(requestedMemory(slurm, 50000, 1), 2000) << "the user's word counts";
  EXPECT_EQ(requestedMemory(slurm, 50000, 2), 4000) << "but for what was killed with it";
}

class OfAnArray : public ::testing::Test {
 protected:
  void writeArray(const std::string& script, int starts = 1) const {
    writeTaskArray({"name",
                    {{{"/bin/true"}, folder.file("log0")}, {{"/bin/sh", "-c", script}, folder.file("log1")}},
                    starts,
                    {}},
                   folder.path());
  }
  int perform(std::size_t index = 1) const {
    return performArrayTask(folder.path(), index, [] { return false; });
  }
  const TemporaryFolder folder;
};

TEST_F(OfAnArray, FilesComeBackAsTheyWere) {
  writeTaskArray({"a name", {{{"/bin/echo", "a b", "c\nd", "e\"f"}, "/l/o g"}}, 3, {{"/p", "12,34"}}},
                 folder.path());
  const auto array = readTaskArray(folder.path());
  EXPECT_EQ(array.name, "a name");
  EXPECT_EQ(array.starts, 3);
  EXPECT_EQ(array.program.at("/p"), "12,34");
  EXPECT_EQ(array.tasks.at(0).command, (std::vector<std::string>{"/bin/echo", "a b", "c\nd", "e\"f"}));
  EXPECT_EQ(array.tasks.at(0).log, "/l/o g");
  EXPECT_FALSE(readTaskEnd(folder.path(), 0).has_value());
  writeTaskEnd(folder.path(), 0, {143, "its job was cancelled"});
  EXPECT_EQ(readTaskEnd(folder.path(), 0)->exit_code, 143);
  EXPECT_EQ(readTaskEnd(folder.path(), 0)->reason, "its job was cancelled");
  folder.write("tasks.json", "{\"name\": 1}");
  EXPECT_THROW(readTaskArray(folder.path()), InputError);
}

TEST_F(OfAnArray, ATaskLeavesWord) {
  writeArray("echo done; exit 5");
  EXPECT_EQ(perform(), 5);
  EXPECT_EQ(folder.read("log1"), "done\n");
  EXPECT_EQ(readTaskEnd(folder.path(), 1)->exit_code, 5);
  EXPECT_TRUE(hasBegun(folder.path(), 1));
  EXPECT_FALSE(hasBegun(folder.path(), 0));
  EXPECT_THAT(lostStarts(folder.path(), 1), IsEmpty());
}

TEST_F(OfAnArray, WhatIsOverOrGoneIsNotDone) {
  writeArray("echo done");
  writeTaskEnd(folder.path(), 1, {1, "given up"});
  EXPECT_THROW(perform(), InputError);
  EXPECT_THROW(perform(2), InputError);
  fs::remove(folder.file("tasks.json"));
  EXPECT_THROW(perform(0), InputError);
  EXPECT_FALSE(fs::exists(folder.file("log1")));
}

TEST_F(OfAnArray, EarlierStartsAreToldAndBounded) {
  writeArray("echo done", 2);
  noteStart(folder.path(), 1);  // and its node was never heard of again
  EXPECT_EQ(perform(), 0);
  const auto lost = lostStarts(folder.path(), 1);
  ASSERT_THAT(lost, SizeIs(1));
  EXPECT_THAT(lost[0].reason, AllOf(HasSubstr("lost on node "), HasSubstr("the queue began it again")));
  EXPECT_THAT(lost[0].started, testing::MatchesRegex("20..-..-..T..:..:..Z"));
  fs::remove(folder.file("1.exit"));
  EXPECT_EQ(perform(), 1) << "a third time is more than two";
  EXPECT_EQ(folder.read("log1"), "done\n");
  EXPECT_THAT(readTaskEnd(folder.path(), 1)->reason, HasSubstr("lost on node"));
}

TEST_F(OfAnArray, WhatWasToldToEndMayBeBegunAgain) {
  writeArray("echo done", 2);
  noteStart(folder.path(), 1);
  writeTaskEnd(folder.path(), 1, {4, ""});  // by its node, when the queue took it back
  EXPECT_EQ(perform(), 0);
  EXPECT_EQ(readTaskEnd(folder.path(), 1)->exit_code, 0);
  EXPECT_THAT(lostStarts(folder.path(), 1), SizeIs(1));
  writeTaskEnd(folder.path(), 1, {4, "given up"});
  EXPECT_THROW(perform(), InputError);
}

TEST_F(OfAnArray, AnotherProgramIsRefused) {
  const auto program = folder.write("program", "1");
  auto stamps = coarseStamps({program});
  writeTaskArray({"name", {{{"/bin/true"}, folder.file("log")}}, 1, stamps}, folder.path());
  EXPECT_EQ(perform(0), 0);
  fs::remove(folder.file("0.exit"));
  folder.write("program", "other");
  writeTaskArray({"name", {{{"/bin/true"}, folder.file("log")}}, 9, stamps}, folder.path());
  EXPECT_EQ(perform(0), 1);
  EXPECT_EQ(readTaskEnd(folder.path(), 0)->reason,
            "the program has been replaced since the job was submitted");
}

TEST_F(OfAnArray, ATaskThatIsGivenUpEnds) {
  writeArray("echo $$ > " + folder.file("pid").string() + "; exec sleep 60");
  std::thread giver([this] {
    while (folder.read("pid").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    writeTaskEnd(folder.path(), 1, {1, "its node failed"});
  });
  EXPECT_EQ(perform(), 1);
  giver.join();
  EXPECT_NE(kill(std::stoi(folder.read("pid")), 0), 0) << "its process has ended";
  EXPECT_EQ(readTaskEnd(folder.path(), 1)->reason, "its node failed") << "and says no other word";
}

// Slurm sends SIGTERM to every process of a job; the task is to be told once, and by its parent.
TEST_F(OfAnArray, OnlyTheParentTellsAChildToEnd) {
  writeArray("trap 'echo told >> " + folder.file("told").string() + "; exit 4' INT; echo > " +
             folder.file("ready").string() + "; kill -TERM $$; while true; do sleep 0.05; done");
  const int code = performArrayTask(folder.path(), 1, [this] { return fs::exists(folder.file("ready")); });
  EXPECT_EQ(code, 4);
  EXPECT_EQ(folder.read("told"), "told\n");
}

// Whatever kills a task that was told to end, the queue may begin it again.
TEST_F(OfAnArray, WhoIsKilledAfterItWasToldMayBeBegunAgain) {
  const std::string ready = folder.file("ready").string();
  const std::vector<std::string> scripts{
      "echo > " + ready + "; exec sleep 60",
      "trap 'kill -KILL $$' INT; echo > " + ready + "; while true; do sleep 0.05; done"};
  for (const auto& script : scripts) {
    fs::remove(ready);
    writeArray(script, 10);
    EXPECT_EQ(performArrayTask(folder.path(), 1, [&] { return fs::exists(ready); }), 4) << script;
    ASSERT_TRUE(readTaskEnd(folder.path(), 1).has_value()) << script;
    EXPECT_EQ(readTaskEnd(folder.path(), 1)->exit_code, 4) << script;
  }
  writeArray("kill -KILL $$", 10);
  EXPECT_EQ(perform(), 137) << "nobody told it";
}

TEST(ToolCalls, AnswersComeBack) {
  const TemporaryFolder folder;
  ToolCall call({"sh", "-c", "echo one; echo two >&2; exit 3"}, folder.file("a/answer"));
  EXPECT_EQ(ToolCall::wait(call, 10), 3);
  EXPECT_EQ(call.answer(), "one\ntwo\n");
  EXPECT_EQ(call.lastWords(), "two");
  EXPECT_EQ(call.ended(), 3) << "asked again";
  ToolCall slow({"sleep", "60"}, folder.file("a/answer"));
  EXPECT_EQ(call.answer(), "") << "the answer of before is gone";
  EXPECT_EQ(ToolCall::wait(slow, 0.1), 137);
  EXPECT_THROW(ToolCall({"no-such-command"}, folder.file("a/answer")), ConfigError);
}

}  // namespace
}  // namespace roomgraph::test
