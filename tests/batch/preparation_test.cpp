// SPDX-License-Identifier: BSD-3-Clause
// From planned runs to tasks, with a program and an inspector that are made up.
#include "preparation.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class MadeUpNeeds : public RunInspector {
 public:
  RunNeeds needsOf(const BatchVariant&, const std::filesystem::path&) override { return needs; }
  RunNeeds needs;
};

class Prepared : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder.file("out/runs/lab--default"));
    folder.write("lab.rawlog", "abc");
    program.parts = {folder.write("program", "v1")};
    plan = planBatch(jobsOfRecordings({folder.file("lab.rawlog").string()}), folder.file("out"));
  }
  PreparedRun prepare() {
    FileHashes hashes(nullptr, nullptr);
    return RunPreparer(plan, folder.file("out"), program, inspector, hashes).prepare(0);
  }
  /// As if the run had been done.
  void complete(PreparedRun run) const {
    run.task.planned.status = "complete";
    run.task.planned.keep = toText(run.task.keep);
    run.task.planned.command = {"what", "was", "called"};
    run.task.planned.wall_s = 12;
    writeRunResult(run.task.planned, folder.file("out/runs/lab--default/result.json"));
  }
  void failEvaluation() const {
    RunResult result = readRunResult(folder.file("out/runs/lab--default/result.json"));
    result.reason = "evaluate trajectory: disk full";
    writeRunResult(result, folder.file("out/runs/lab--default/result.json"));
  }
  const TemporaryFolder folder;
  BatchProgram program{"/program", "1.0", "rev", {}, {}};
  MadeUpNeeds inspector;
  BatchPlan plan;
};

TEST_F(Prepared, WhatIsCompleteIsNotNeeded) {
  EXPECT_EQ(prepare().why, "was not finished") << "its folder is there";
  complete(prepare());
  EXPECT_FALSE(prepare().needed);
  program.parts = {folder.write("program", "version 2")};
  EXPECT_EQ(prepare().why, "the program has changed");
}

TEST_F(Prepared, AnEvaluationThatFailedIsDoneAgain) {
  complete(prepare());
  failEvaluation();
  EXPECT_TRUE(prepare().needed);
  EXPECT_FALSE(prepare().task.run_again);
}

TEST_F(Prepared, LessThanIsToBeKeptIsNotEnough) {
  plan.jobs.keep = Keep::kMap;
  complete(prepare());
  plan.jobs.keep = Keep::kSummary;
  EXPECT_FALSE(prepare().needed);
  plan.jobs.keep = Keep::kAll;
  EXPECT_TRUE(prepare().needed);
}

TEST_F(Prepared, ANewTruthIsOnlyEvaluatedWhenAllWasKept) {
  complete(prepare());
  folder.write("lab.rawlog.GT.txt", "0 0 0 0 0 0 0 1");
  const PreparedRun evaluated = prepare();
  EXPECT_TRUE(evaluated.needed);
  EXPECT_FALSE(evaluated.task.run_again);
  EXPECT_EQ(evaluated.task.planned.wall_s, 12);
  EXPECT_THAT(evaluated.task.run, Contains("called"));
  std::filesystem::remove(folder.file("lab.rawlog.GT.txt"));
  plan.jobs.keep = Keep::kMap;
  complete(prepare());
  folder.write("lab.rawlog.GT.txt", "0 0 0 0 0 0 0 1");
  EXPECT_TRUE(prepare().task.run_again) << "what an evaluation reads is gone";
}

TEST_F(Prepared, DetectionsAreRecordedOrReplayed) {
  EXPECT_TRUE(prepare().detections.empty());
  inspector.needs.detections = "models=net";
  PreparedRun record = prepare(), replay = prepare();
  EXPECT_EQ(record.detections.parent_path(), folder.file("out/detections"));
  RunPreparer::shareDetections(record, false);
  EXPECT_THAT(record.task.run, Contains("--save-detections"));
  RunPreparer::shareDetections(replay, true);
  EXPECT_THAT(replay.task.run, Contains("detection.file=" + replay.detections.string()));
  EXPECT_THAT(replay.task.run, Contains("detection.models="));
  EXPECT_EQ(record.task.planned.key, replay.task.planned.key)
      << "how the boxes come is no part of what comes out";
}

TEST_F(Prepared, AProgramThatIsReplacedIsNoticed) {
  FileHashes hashes(nullptr, nullptr);
  const RunPreparer preparer(plan, folder.file("out"), program, inspector, hashes);
  preparer.requireSameProgram();
  folder.write("program", "version 2");
  EXPECT_THAT(messageOf<RunError>([&] { preparer.requireSameProgram(); }),
              HasSubstr("has been replaced while the batch was at work"));
}

}  // namespace
}  // namespace roomgraph::test
