// SPDX-License-Identifier: BSD-3-Clause
// Tasks there and back, and carried out with a made-up program.
#include "roomgraph/batch/run_task.h"

#include <gmock/gmock.h>

#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A shell script in place of the program: $1 is run or evaluate.
class TaskOfAScript : public ::testing::Test {
 protected:
  int perform(
      const std::string& script, const std::function<bool()>& interrupted = [] { return false; }) {
    const auto program = folder.write("program", "#!/bin/sh\ncd " + folder.path().string() + "\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    task.folder = folder.path();
    task.planned.name = "x--default";
    task.planned.input.name = "x";
    task.run = {"run", "x.rawlog"};
    const int exit_code = performRunTask(task, program, interrupted);
    result = readRunResult(folder.file("result.json"));
    return exit_code;
  }
  static constexpr const char* kSummary =
      "echo '{\"counts\": {\"frames\": 7}, \"timings\": {\"replay\": {\"calls\": 2, \"total_ms\": 3, "
      "\"max_ms\": 2}}}' > summary.json\n";
  const TemporaryFolder folder;
  RunTask task;
  RunResult result;
};

TEST_F(TaskOfAScript, ComesBackFromItsFile) {
  task.folder = "/a b";
  task.planned.name = "n";
  task.planned.parameters = {{"a.b", "c"}};
  task.run = {"run", "with \"quotes\""};
  task.evaluations = {{"map", {"map", "t"}, {"map.yaml"}}};
  task.time_limit_s = 2.5;
  task.keep = Keep::kMap;
  task.run_again = false;
  writeRunTask(task, folder.file("task.json"));
  const RunTask back = readRunTask(folder.file("task.json"));
  EXPECT_EQ(back.folder, task.folder);
  EXPECT_EQ(back.planned.parameters, task.planned.parameters);
  EXPECT_EQ(back.run, task.run);
  EXPECT_EQ(back.evaluations[0].arguments, task.evaluations[0].arguments);
  EXPECT_EQ(back.evaluations[0].needs, task.evaluations[0].needs);
  EXPECT_EQ(back.time_limit_s, 2.5);
  EXPECT_EQ(back.keep, Keep::kMap);
  EXPECT_FALSE(back.run_again);
}

TEST_F(TaskOfAScript, LeavesFiguresTimesAndFiles) {
  task.evaluations = {{"trajectory", {"trajectory"}, {"trajectory.tum"}}, {"map", {"map"}, {"map.yaml"}}};
  EXPECT_EQ(perform(std::string("[ $1 = run ] && echo hello && echo pose > trajectory.tum && ") + kSummary +
                    "[ $1 = evaluate ] && echo '{\"ate\": 0.25}' > $4\nexit 0\n"),
            0);
  EXPECT_EQ(result.status, "complete");
  EXPECT_EQ(result.figures.at("trajectory.ate"), 0.25);
  EXPECT_EQ(result.figures.at("counts.frames"), 7);
  EXPECT_FALSE(result.figures.contains("map.ate")) << "there is no map to evaluate";
  EXPECT_EQ(result.timings.at("replay").calls, 2);
  EXPECT_GT(result.wall_s, 0);
  EXPECT_GT(result.peak_memory_mb, 0);
  EXPECT_EQ(result.files.at("run.log"), 6);
  EXPECT_EQ(folder.read("run.log"), "hello\n");
}

TEST_F(TaskOfAScript, AFailureHasItsReasonFromTheLog) {
  EXPECT_EQ(perform("echo working; echo 'roomgraph: lab.rawlog: no pose could be found' >&2; exit 3\n"), 1);
  EXPECT_EQ(result.status, "failed");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.reason, "lab.rawlog: no pose could be found");
  ASSERT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.failures[0].reason, result.reason);
  perform("kill -9 $$\n");
  EXPECT_EQ(result.exit_code, 137);
  EXPECT_THAT(result.reason, HasSubstr("SIGKILL"));
  perform("exit 7\n");
  EXPECT_EQ(result.reason, "exit code 7");
}

TEST_F(TaskOfAScript, AnEvaluationThatFailsIsAWarning) {
  task.evaluations = {{"trajectory", {"trajectory"}, {}}};
  EXPECT_EQ(perform(std::string("[ $1 = evaluate ] && echo 'roomgraph: no pairs' && exit 1\n") + kSummary),
            0);
  EXPECT_EQ(result.status, "complete");
  EXPECT_EQ(result.reason, "evaluate trajectory: no pairs");
  // All stays for the next time, whatever is to be kept in the end.
  task.keep = Keep::kSummary;
  perform(std::string("[ $1 = run ] && echo x > graph.g2o\n[ $1 = evaluate ] && exit 1\n") + kSummary);
  EXPECT_TRUE(result.files.contains("graph.g2o"));
  EXPECT_EQ(result.keep, "all");
}

TEST_F(TaskOfAScript, WhoIsOverTheTimeIsToldToEnd) {
  task.time_limit_s = 0.3;
  EXPECT_EQ(perform("trap 'echo told > told.txt; exit 4' INT\nfor i in 1 2 3 4 5 6 7 8 9; do sleep 0.1; "
                    "done; sleep 1\n"),
            1);
  EXPECT_EQ(result.reason, "over its time limit of 0 s");
  EXPECT_EQ(folder.read("told.txt"), "told\n") << "SIGINT, so that it can write what it has";
}

TEST_F(TaskOfAScript, AnInterruptionIsNoFailure) {
  EXPECT_EQ(
      perform("trap 'exit 4' INT\nfor i in 1 2 3 4 5 6 7 8 9; do sleep 0.1; done\n", [] { return true; }), 4);
  EXPECT_EQ(result.status, "interrupted");
  EXPECT_TRUE(result.failures.empty());
}

TEST_F(TaskOfAScript, AWholeRunOutlivesItsEvaluation) {
  task.evaluations = {{"trajectory", {"trajectory"}, {}}};
  task.planned.key = "k";
  task.keep = Keep::kSummary;
  const std::string script = std::string("[ $1 = evaluate ] && : > begun && sleep 5\n: > graph.g2o\n") + kSummary;
  const auto begun = [this] { return std::filesystem::exists(folder.file("begun")); };
  for (const bool again : {true, false}) {
    task.run_again = again;
    std::filesystem::remove(folder.file("begun"));
    EXPECT_EQ(perform(script, begun), 4);
    EXPECT_EQ(result.status, "complete");
    EXPECT_EQ(result.key, "k");
    EXPECT_EQ(result.keep, "all") << "the evaluation needs it the next time";
    EXPECT_TRUE(std::filesystem::exists(folder.file("graph.g2o")));
    EXPECT_EQ(result.reason, withoutEvaluation(task).reason);
    EXPECT_THAT(result.reason, HasSubstr("not finished"));
  }
}

TEST_F(TaskOfAScript, GoesOnFromACheckpointThatFits) {
  const std::string resumed = "run x.rawlog --resume " + folder.path().string() + "\n";
  const std::string notes = std::string("[ $1 = run ] && echo $* >> words.txt\n") + kSummary;
  perform(notes);
  EXPECT_EQ(folder.read("words.txt"), "run x.rawlog\n") << "there is no checkpoint";
  std::filesystem::create_directory(folder.file("roomgraph_checkpoint"));
  folder.write("roomgraph_checkpoint/run.json", "{}");
  EXPECT_EQ(perform("rm words.txt\n" + notes), 0);
  EXPECT_EQ(folder.read("words.txt"), resumed);
  // One of another program or configuration is refused, and the run begins anew.
  for (const std::string code : {"2", "3"}) {
    folder.write("words.txt", "");
    EXPECT_EQ(perform(notes + "[ \"$3\" = --resume ] && exit " + code + "\nexit 0\n"), 0);
    EXPECT_EQ(folder.read("words.txt"), resumed + "run x.rawlog\n");
  }
  folder.write("words.txt", "");
  EXPECT_EQ(perform(notes + "exit 1\n"), 1);
  EXPECT_EQ(folder.read("words.txt"), resumed) << "a full disk is as full for a run that begins";
}

TEST_F(TaskOfAScript, OnlyWhatIsWantedIsKept) {
  const std::string script =
      std::string(
          "for f in live.tum graph.g2o map.rgmap report.html config.ini mine.txt; do echo x > $f; done\n") +
      kSummary;
  task.keep = Keep::kMap;
  perform(script);
  EXPECT_TRUE(result.files.contains("map.rgmap"));
  EXPECT_FALSE(result.files.contains("graph.g2o"));
  task.keep = Keep::kSummary;
  perform(script);
  EXPECT_FALSE(result.files.contains("map.rgmap"));
  for (const char* name : {"config.ini", "summary.json", "mine.txt", "run.log"})
    EXPECT_TRUE(result.files.contains(name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder.file("report.html")));
}

}  // namespace
}  // namespace roomgraph::test
