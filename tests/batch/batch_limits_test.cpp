// SPDX-License-Identifier: BSD-3-Clause
// Limits of a batch, broken inputs, wrong use.
#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class BatchLimited : public SmallBatch {
 protected:
  /// Most runs between their start and their end, by the lines of events.
  static int mostAtOnce(const std::string& err) {
    int now = 0, most = 0;
    for (const auto& line : linesOf(err)) {
      now += line.starts_with("start ");
      most = std::max(most, now);
      now -= line.starts_with("complete ") || line.starts_with("failed ");
    }
    return most;
  }
};

TEST_F(BatchLimited, JobsAndMemoryBoundWhatRunsAtOnce) {
  // Of three lengths: recordings with the same bytes share their detections, so the first would be waited
  // for.
  const auto make = [this](int steps) {
    for (const char* name : {"a", "b", "c"}) makeRecording(name, steps++);
  };
  make(8);
  const auto three = batch({jobs(), "-o", "out", "--jobs", "3", "--keep", "summary"});
  EXPECT_EQ(mostAtOnce(three.err), 3) << three.err;
  make(11);
  const auto tight = batch({jobs(), "-o", "out", "--jobs", "3", "--memory", "150 MB", "--keep", "summary"});
  EXPECT_EQ(mostAtOnce(tight.err), 1) << tight.err;
  EXPECT_THAT(tight.out, HasSubstr("3 runs done"));
}

TEST_F(BatchLimited, ABrokenInputCostsItselfOnly) {
  makeRecording("a");
  folder.write("data/b.rawlog", "this is no rawlog");
  const auto ended = batch({jobs(), "-o", "out", "--retries", "3"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(linesOf(ended.err).back(),
              AllOf(HasSubstr("1 of 2 runs failed, the first: b--default: "), HasSubstr("b.rawlog")));
  EXPECT_EQ(result("a--default").status, "complete");
  EXPECT_EQ(result("b--default").status, "failed");
  EXPECT_EQ(result("b--default").failures.size(), 1u) << "it would be no better next time";
  const auto status = batch({"status", "out"});
  EXPECT_THAT(status.out, AllOf(HasSubstr("b--default"), HasSubstr("failed"), HasSubstr("b.rawlog")));
}

TEST_F(BatchLimited, ARunHasItsTime) {
  makeRecording("a", 4000);
  const auto ended = batch({jobs(), "-o", "out", "--time", "4 s", "--retries", "2"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(result("a--default").reason, "over its time limit of 4 s");
  EXPECT_EQ(result("a--default").failures.size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(runFolder("a--default") / "summary.json")) << "what it had is written";
}

TEST_F(BatchLimited, WrongUseIsOneLine) {
  makeRecording("a");
  expectOneLine(batch({}), 2, HasSubstr("needs a job file or recordings"));
  expectOneLine(batch({"data/a.rawlog"}), 2, HasSubstr("needs -o DIR"));
  expectOneLine(batch({"data/none.rawlog", "-o", "out"}), 3, HasSubstr("none.rawlog: no such file"));
  expectOneLine(batch({"none.yaml", "-o", "out"}), 3, HasSubstr("none.yaml"));
  expectOneLine(batch({jobs("  - {name: x, set: lidar.enable=true}\n"), "-o", "out"}), 2,
                AllOf(HasSubstr("variant 'x'"), HasSubstr("did you mean 'enabled'")));
  expectOneLine(batch({jobs(), "data/a.rawlog", "-o", "out"}), 2, HasSubstr("a job file stands alone"));
  expectOneLine(batch({"data/a.rawlog", "-o", "out", "--time", "soon"}), 2, HasSubstr("--time: 'soon'"));
  expectOneLine(batch({"data/a.rawlog", "-o", "data/a.rawlog"}), 1, HasSubstr("cannot be made"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("out"))) << "nothing is begun that cannot be ended";
}

TEST_F(BatchLimited, LittleIsKept) {
  makeRecording("a");
  ASSERT_EQ(batch({jobs("  - name: default\n", "keep: summary\n"), "-o", "out"}).exit_code, 0);
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(runFolder("a--default")))
    left.insert(entry.path().filename().string());
  EXPECT_EQ(left,
            (std::set<std::string>{"config.ini", "objects.ini", "result.json", "run.log", "summary.json"}));
}

}  // namespace
}  // namespace roomgraph::test
