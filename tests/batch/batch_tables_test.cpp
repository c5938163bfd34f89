// SPDX-License-Identifier: BSD-3-Clause
// Tables of a batch on the command line.
#include <set>

#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A catalogue of runs that never took place.
class BatchTables : public SmallBatch {
 protected:
  void SetUp() override {
    SmallBatch::SetUp();
    for (int seed = 1; seed <= 8; ++seed)
      for (const bool slow : {false, true}) {
        RunResult r;
        r.variant = slow ? "slow" : "default";
        r.input = {"lab_s" + std::to_string(seed), "lab", seed, "/lab.rawlog", "x", 1};
        r.name = r.input.name + "--" + r.variant;
        r.status = "complete";
        r.figures = {{"trajectory.ate_rmse_m", 0.1 * seed + (slow ? 0.02 : 0)}};
        std::filesystem::create_directories(runFolder(r.name));
        writeRunResult(r, runFolder(r.name) / "result.json");
      }
  }
};

TEST_F(BatchTables, AreMadeFromTheRuns) {
  expectOneLine(batch({"status", "out"}), 3, HasSubstr("'roomgraph batch import out' makes it"));
  const auto taken = batch({"import", "out"});
  EXPECT_THAT(taken.out, HasSubstr("16 results taken in, 16 runs in all"));
  EXPECT_THAT(
      batch({"status", "out"}).out,
      AllOf(HasSubstr("16 runs"), HasSubstr("ATE, m  0.450 (0.275 .. 0.625)  0.470 (0.295 .. 0.645) *")));
  EXPECT_THAT(batch({"compare", "out"}).out,
              AllOf(HasSubstr("Differences from default"), HasSubstr("0.0200 .. 0.0200  0.0078"),
                    HasSubstr("worse")));
  EXPECT_THAT(batch({"compare", "out", "--baseline", "slow"}).out, HasSubstr("better"));
  EXPECT_EQ(batch({"query", "out", "SELECT count(*) AS n FROM figures WHERE variant = 'slow'", "--csv"}).out,
            "n\n8\n");
  const auto lines = linesOf(batch({"export", "out", "csv"}).out);
  ASSERT_EQ(lines.size(), 17u);
  EXPECT_EQ(lines[0],
            "run,input,input_group,seed,variant,status,reason,revision,wall_s,cpu_s,peak_memory_mb,"
            "trajectory.ate_rmse_m");
  EXPECT_EQ(lines[1], "lab_s1--default,lab_s1,lab,1,default,complete,,,0,0,0,0.1");
  EXPECT_EQ(batch({"report", "out"}).out, folder.file("out/report.html").string() + "\n");
  EXPECT_THAT(contentOf(folder.file("out/report.html")), HasSubstr("Batch out"));
}

TEST_F(BatchTables, WrongQuestionsAreOneLine) {
  batch({"import", "out"});
  expectOneLine(batch({"query", "out", "SELEKT"}), 2,
                AllOf(HasSubstr("syntax error"), HasSubstr("tables: runs")));
  expectOneLine(batch({"query", "out", "DROP TABLE runs"}), 2, HasSubstr("only SELECT"));
  expectOneLine(batch({"compare", "out", "--baseline", "slo"}), 2, HasSubstr("did you mean 'slow'"));
  expectOneLine(batch({"status", "nowhere"}), 3, HasSubstr("no such catalogue"));
  expectOneLine(batch({"import", "data"}), 3, HasSubstr("is no folder of a batch"));
  expectOneLine(batch({"export", "out", "xml"}), 2, HasSubstr("xml"));
}

}  // namespace
}  // namespace roomgraph::test
