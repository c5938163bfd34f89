// SPDX-License-Identifier: BSD-3-Clause
// What a batch does, and what it does not do again.
#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BatchAgain : public SmallBatch {};

constexpr const char* kTwoVariants = "  - name: default\n  - {name: no_lidar, set: lidar.enabled=false}\n";

TEST_F(BatchAgain, DoesEachRunOnce) {
  makeRecording("a");
  makeRecording("b", 9);
  const auto first = batch({jobs(kTwoVariants), "-o", "out"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("4 runs done, 0 unchanged, 0 failed, 0 left"));
  EXPECT_THAT(first.err,
              AllOf(HasSubstr("start     a--default (new)"), HasSubstr("complete  b--no_lidar: ")));
  EXPECT_EQ(catalogued().size(), 4u);
  EXPECT_EQ(result("a--no_lidar").parameters.at("lidar.enabled"), "false");
  EXPECT_EQ(result("a--default").figures.at("counts.scans"), 8);
  EXPECT_EQ(result("b--default").figures.at("counts.scans"), 9);
  EXPECT_TRUE(std::filesystem::exists(runFolder("a--default") / "report.html"));
  const auto again = batch({jobs(kTwoVariants), "-o", "out"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("0 runs done, 4 unchanged"));
}

TEST_F(BatchAgain, OnlyWhatChangedIsDoneAgain) {
  makeRecording("a");
  makeRecording("b", 9);
  ASSERT_EQ(batch({jobs(kTwoVariants), "-o", "out", "--keep", "summary"}).exit_code, 0);
  std::filesystem::last_write_time(folder.file("data/a.rawlog"),
                                   std::filesystem::file_time_type::clock::now());
  EXPECT_THAT(batch({jobs(kTwoVariants), "-o", "out", "--keep", "summary"}).out,
              HasSubstr("0 runs done, 4 unchanged"))
      << "the bytes count";
  makeRecording("a", 10);
  const auto input = batch({jobs(kTwoVariants), "-o", "out", "--keep", "summary"});
  EXPECT_THAT(input.out, HasSubstr("2 runs done, 2 unchanged"));
  EXPECT_THAT(input.err, AllOf(HasSubstr("a--default (the recording has changed)"), Not(HasSubstr("b--"))));
  const auto setting = batch({jobs("  - name: default\n  - {name: no_lidar, set: [lidar.enabled=false, "
                                   "tracking.max_features=900]}\n"),
                              "-o", "out", "--keep", "summary"});
  EXPECT_THAT(setting.out, HasSubstr("2 runs done, 2 unchanged"));
  EXPECT_THAT(setting.err, HasSubstr("a--no_lidar (the configuration has changed: tracking.max_features)"));
  std::filesystem::remove(runFolder("b--default") / "result.json");
  EXPECT_THAT(batch({jobs(), "-o", "out", "--keep", "summary"}).err,
              HasSubstr("b--default (was not finished)"));
  EXPECT_THAT(batch({jobs(), "-o", "out", "--keep", "map"}).err,
              HasSubstr("b--default (more is to be kept)"));
  EXPECT_TRUE(std::filesystem::exists(runFolder("b--default") / "map.rgmap"));
}

TEST_F(BatchAgain, ATruthThatComesLaterIsEvaluatedOnly) {
  makeRecording("a");
  ASSERT_EQ(batch({"data/a.rawlog", "-o", "out"}).exit_code, 0);
  EXPECT_FALSE(result("a--default").figures.contains("trajectory.ate_rmse_m"));
  const auto before = result("a--default");
  std::filesystem::copy_file(runFolder("a--default") / "trajectory.tum", folder.file("data/a.rawlog.GT.txt"));
  const auto later = batch({"data/a.rawlog", "-o", "out"});
  EXPECT_THAT(later.err, HasSubstr("evaluate  a--default (the truth or the evaluation has changed)"));
  const auto after = result("a--default");
  EXPECT_NEAR(after.figures.at("trajectory.ate_rmse_m"), 0, 1e-6) << "the truth is its own trajectory";
  EXPECT_EQ(after.wall_s, before.wall_s);
  EXPECT_EQ(after.command, before.command);
  EXPECT_THAT(batch({"data/a.rawlog", "-o", "out"}).out, HasSubstr("1 unchanged"));
}

TEST_F(BatchAgain, ATruthThatCannotBeUsedIsAFailure) {
  makeRecording("a");
  folder.write("data/a.rawlog.GT.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n");  // of another day
  const auto first = batch({"data/a.rawlog", "-o", "out"});
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_THAT(first.out, HasSubstr("1 runs done, 0 unchanged, 0 failed"));
  EXPECT_THAT(first.err, HasSubstr("1 of 1 runs done could not be evaluated, the first: a--default: evaluate trajectory: "));
  EXPECT_EQ(result("a--default").status, "complete");
  std::filesystem::copy_file(runFolder("a--default") / "trajectory.tum", folder.file("data/a.rawlog.GT.txt"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(batch({"data/a.rawlog", "-o", "out"}).exit_code, 0);
}

TEST_F(BatchAgain, SimulatedInputsAreMadeOnce) {
  const std::string world = std::string(ROOMGRAPH_SOURCE_DIR) + "/rawlogs/tiny_room.json";
  folder.write("jobs.yaml", "inputs:\n  - simulate: {world: " + world + ", seeds: 4}\nkeep: summary\n");
  const auto first = batch({"jobs.yaml", "-o", "out"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, AllOf(HasSubstr("simulate  tiny_room_s4"), HasSubstr("simulated tiny_room_s4")));
  const auto run = result("tiny_room_s4--default");
  EXPECT_EQ(run.input.seed, 4);
  EXPECT_EQ(run.input.group, "tiny_room");
  EXPECT_LT(run.figures.at("trajectory.ate_rmse_m"), 0.1) << "its truth is found";
  EXPECT_EQ(run.figures.at("objects.recall"), 1);
  EXPECT_THAT(batch({"jobs.yaml", "-o", "out"}).err, Not(HasSubstr("simulate")));
}

TEST_F(BatchAgain, ADryRunLeavesNothing) {
  makeRecording("a");
  const auto plan = batch({jobs(kTwoVariants), "-o", "out", "--dry-run"});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, AllOf(HasSubstr("run       a--no_lidar (new)"),
                              HasSubstr("2 of 2 runs to do: 1 inputs, 2 variants")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
}

}  // namespace
}  // namespace roomgraph::test
