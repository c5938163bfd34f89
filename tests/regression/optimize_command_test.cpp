// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph optimize`: chi-squared of a small graph and of a run's graph, failures.
#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

// A square of one metre; the robot claims to have come home 0.4 m short. Four unit edges: the closure error
// of 0.4 m, all translation, is what the optimum spreads.
const char* const kSquare =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 1 1 0\nVERTEX_SE2 3 0 1 0\n"
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1e6\nEDGE_SE2 1 2 0 1 0 1 0 0 1 0 1e6\n"
    "EDGE_SE2 2 3 -1 0 0 1 0 0 1 0 1e6\nEDGE_SE2 3 0 0 -0.6 0 1 0 0 1 0 1e6\nODD 1\n";

TEST(OptimizeCommand, PrintsChiSquaredBeforeAndAfter) {
  TemporaryFolder folder;
  const auto file = folder.write("square.g2o", kSquare);
  const auto result = call(folder.path(), {"optimize", file.string(), "-o", folder.file("out.g2o").string(),
                                           "--quiet", "--keep-start"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("2D, 4 poses, 4 edges"));
  EXPECT_THAT(result.out, HasSubstr("chi2 before 0.1600"));
  EXPECT_THAT(result.out, HasSubstr("chi2 after  0.0400"));  // 0.4^2 / 4, with turning all but forbidden
  EXPECT_THAT(result.err, HasSubstr("1 lines 'ODD' skipped"));
  const auto again = call(folder.path(), {"optimize", folder.file("out.g2o").string(), "-o",
                                          folder.file("again.g2o").string(), "--quiet"});
  EXPECT_THAT(again.out, HasSubstr("chi2 before 0.0400"));
  EXPECT_THAT(again.out, HasSubstr("chi2 after  0.0400"));
}

TEST(OptimizeCommand, ReadsTheGraphOfARun) {
  TemporaryFolder folder;
  test::writeRawlog(folder.file("tiny.rawlog"), TinyRecording(10).records({true, false, true}));
  ASSERT_EQ(
      call(folder.path(), {"run", folder.file("tiny.rawlog").string(), "-o", folder.file("out").string(),
                           "--quiet", "--no-snapshot", "--set", "backend.node_distance_m=0.1"})
          .exit_code,
      0);
  const auto result = call(folder.path(), {"optimize", (folder.file("out") / "graph.g2o").string(), "-o",
                                           folder.file("again.g2o").string(), "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "no line of it is skipped";
  EXPECT_THAT(result.out, HasSubstr("3D, "));
}

TEST(OptimizeCommand, Failures) {
  TemporaryFolder folder;
  const std::string none = folder.file("none.g2o").string(), out = folder.file("out.g2o").string(),
                    bad = folder.write("bad.g2o", "VERTEX_SE2 0 0 0\n").string(),
                    good = folder.write("good.g2o", kSquare).string();
  expectOneLine(call(folder.path(), {"optimize", none, "-o", out}), 3, HasSubstr("none.g2o"));
  expectOneLine(call(folder.path(), {"optimize", bad, "-o", out}), 3, HasSubstr("bad.g2o:1"));
  expectOneLine(call(folder.path(), {"optimize", good}), 2, HasSubstr("--output"));
  expectOneLine(call(folder.path(), {"optimize", good, "-o", out, "--max-iterations", "0"}), 2,
                HasSubstr("--max-iterations"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roomgraph::test
