// SPDX-License-Identifier: BSD-3-Clause
// Recordings in pieces that are run side by side and joined.
#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BatchSplitTest : public SmallBatch {
 protected:
  std::size_t posesIn(const std::string& run) const {
    return linesOf(contentOf(runFolder(run) / "trajectory.tum")).size();
  }
};

TEST_F(BatchSplitTest, PiecesAreOneResult) {
  makeRecording("a", 60);  // 6 s
  makeRecording("b", 12);
  const auto whole = batch({jobs(), "-o", "whole"});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const TinyRecording truth(60);
  std::string text;
  for (int i = 0; i < truth.steps(); ++i) {
    const Pose2 pose = truth.truth(i);
    text += std::to_string(truth.time(i)) + " " + std::to_string(pose.x) + " " + std::to_string(pose.y) +
            " " + std::to_string(pose.yaw) + "\n";
  }
  folder.write("data/a.rawlog.GT.txt", text);
  const std::vector<std::string> words{"jobs.yaml", "-o", "out", "--split", "3 s", "--overlap", "1 s"};
  const auto split = batch(words);
  ASSERT_EQ(split.exit_code, 0) << split.err;
  EXPECT_THAT(split.out, HasSubstr("4 runs done")) << "two pieces, what is joined from them, and a short one";
  EXPECT_THAT(split.err, AllOf(HasSubstr("complete  a--default.p01"), HasSubstr("complete  a--default: ")));
  const auto first = result("a--default.p01"), second = result("a--default.p02"),
             joined = result("a--default");
  EXPECT_EQ(first.variant, "default.piece");
  EXPECT_EQ(second.input.name, "a.p02");
  EXPECT_EQ(joined.variant, "default");
  EXPECT_EQ(joined.command.at(1), "join");
  EXPECT_EQ(joined.figures.at("counts.scans"),
            first.figures.at("counts.scans") + second.figures.at("counts.scans"));
  EXPECT_EQ(posesIn("a--default"),
            linesOf(contentOf(folder.file("whole/runs/a--default/trajectory.tum"))).size());
  EXPECT_LT(joined.figures.at("trajectory.ate_rmse_m"), 0.05);
  EXPECT_FALSE(first.figures.contains("map.agreement"));
  EXPECT_TRUE(std::filesystem::exists(runFolder("a--default") / "map.rgmap"));
  EXPECT_FALSE(std::filesystem::exists(runFolder("b--default.p01"))) << "hardly longer than a piece";
  EXPECT_THAT(batch(words).out, HasSubstr("0 runs done, 4 unchanged"));
  makeRecording("a", 62);
  EXPECT_THAT(batch(words).out, HasSubstr("3 runs done, 1 unchanged"));
}

TEST_F(BatchSplitTest, APieceThatFailsFailsTheWholeOnly) {
  makeRecording("a", 60);
  const auto ended = batch({jobs(), "-o", "out", "--split", "3 s", "--overlap", "1 s", "--time", "0.2 s"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(result("a--default").status, "failed");
  EXPECT_THAT(result("a--default").reason, HasSubstr("its piece a--default.p01 failed: over its time limit"));
  folder.write("data/a.rawlog", "none");
  const auto broken = batch({jobs(), "-o", "out2", "--split", "3 s", "--overlap", "1 s"});
  EXPECT_THAT(broken.err, HasSubstr("its input a could not be read: "));
}

TEST_F(BatchSplitTest, WrongUseIsOneLine) {
  makeRecording("a");
  expectOneLine(batch({jobs(), "-o", "out", "--split", "30 s"}), 2, HasSubstr("three times as long"));
  expectOneLine(batch({jobs(), "-o", "out", "--split", "soon"}), 2, HasSubstr("--split: 'soon'"));
  expectOneLine(call(folder.path(), {"map", "join", "x", "-o", "y"}), 2, HasSubstr("at least two runs"));
  expectOneLine(call(folder.path(), {"map", "join", "x", "z", "-o", folder.file("y").string()}), 3,
                HasSubstr("x/map.rgmap"));
}

TEST_F(BatchSplitTest, PiecesWithoutCommonTimeAreRefused) {
  makeRecording("a", 40);
  const auto piece = [&](const char* name, const char* from, const char* until) {
    const auto run =
        call(folder.path(), {"run", folder.file("data/a.rawlog").string(), "-o", folder.file(name).string(),
                             "--from", from, "--until", until, "--quiet", "--no-snapshot", "--no-report"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  };
  piece("one", "0", "1.5");
  piece("two", "2.5", "0");
  expectOneLine(
      call(folder.path(), {"map", "join", folder.file("one").string(), folder.file("two").string(), "-o",
                           folder.file("both").string()}),
      1, AllOf(HasSubstr("two cannot be joined to what is before it"), HasSubstr("0 instants in common")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("both/map.rgmap")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("one/map.rgmap"))) << "pieces stay valid";
}

}  // namespace
}  // namespace roomgraph::test
