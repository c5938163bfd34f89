// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph report`, and the page that `run` leaves.
#include <sys/resource.h>

#include "made_up_run.h"
#include "program.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class ReportCommand : public ::testing::Test {
 protected:
  CallResult report(const std::vector<std::string>& more) {
    std::vector<std::string> words{"report"};
    words.insert(words.end(), more.begin(), more.end());
    return call(folder.path(), words);
  }
  CallResult run(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run",     std::string(ROOMGRAPH_SOURCE_DIR) + "/rawlogs/tiny_room.rawlog",
                                   "-o",      out.string(),
                                   "--quiet", "--no-snapshot"};
    words.insert(words.end(), more.begin(), more.end());
    return call(folder.path(), words);
  }
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "out";
};

TEST_F(ReportCommand, StandsBesideTheRunOrWhereItIsAskedFor) {
  const TemporaryFolder made_up;
  writeRun(made_up);
  const CallResult beside = report({made_up.path().string() + "/"});
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_EQ(beside.err, "");
  const auto page = contentOf(made_up.file("report.html"));
  EXPECT_EQ(json::parse(dataText(page))["runs"][0]["name"], made_up.path().string());
  const auto place = folder.file("two.html").string();
  EXPECT_EQ(report({made_up.path().string(), made_up.path().string(), "-o", place}).exit_code, 0);
  EXPECT_EQ(json::parse(dataText(contentOf(place)))["runs"].size(), 2u);
}

TEST_F(ReportCommand, WrongUseIsOneLine) {
  const TemporaryFolder made_up;
  writeRun(made_up);
  const std::string good = made_up.path().string();
  expectOneLine(report({folder.file("none").string()}), 3, HasSubstr("is no folder of a run"));
  expectOneLine(report({good, good}), 2, HasSubstr("-o"));
  expectOneLine(report({good, "-o", folder.file("x.png").string()}), 2, HasSubstr("something.html"));
  expectOneLine(report({good, "--truth", folder.file("no.tum").string()}), 3, HasSubstr("no.tum"));
  expectOneLine(report({good, "-o", folder.file("no/x.html").string()}), 1, HasSubstr("x.html"));
  std::filesystem::remove(made_up.file("graph.g2o"));
  expectOneLine(report({good}), 0,
                HasSubstr("warning: " + made_up.file("graph.g2o").string() + ": is not there"));
}

TEST_F(ReportCommand, ARunLeavesItsReport) {
  const CallResult result = run({"--set", "tracking.max_features=900"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("report.html"));
  const json reported = json::parse(dataText(contentOf(out / "report.html")))["runs"][0];
  EXPECT_EQ(reported["name"], out.string());
  EXPECT_TRUE(reported["missing"].empty()) << reported["missing"];
  const json summary = json::parse(contentOf(out / "summary.json"));
  EXPECT_EQ(reported["counts"], summary["counts"]);
  EXPECT_EQ(reported["closures"].size(), summary["counts"]["loop_closures"]);
  EXPECT_EQ(reported["poses"], linesOf(contentOf(out / "trajectory.tum")).size());
  std::vector<std::string> changed;
  for (const json& row : reported["config"])
    if (row.contains("shipped"))
      changed.push_back(row["key"].get<std::string>() + "=" + row["shipped"].get<std::string>());
  EXPECT_THAT(changed, ::testing::ElementsAre("max_features=1000"));
  ASSERT_EQ(run({"--no-report"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(out / "report.html"))
      << "that of the earlier run would tell of another";
}

// No file may grow beyond 60 kB, which the page does and nothing else: a disk that is full in the end.
TEST_F(ReportCommand, ARunIsARunWithoutItsReport) {
  ASSERT_EQ(run({"--until", "2"}).exit_code, 0);
  const auto landmarks = contentOf(out / "landmarks.json");
  EXPECT_GT(std::filesystem::file_size(out / "report.html"), 60000u);
  rlimit former{};
  getrlimit(RLIMIT_FSIZE, &former);
  const rlimit small{60000, former.rlim_max};
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const CallResult result = run({"--until", "2", "--checkpoint", "0"});
  setrlimit(RLIMIT_FSIZE, &former);
  signal(SIGXFSZ, handler);
  expectOneLine(result, 0, HasSubstr("warning: no report.html: "));
  EXPECT_EQ(contentOf(out / "landmarks.json"), landmarks);
  EXPECT_FALSE(std::filesystem::exists(out / "report.html"));
  EXPECT_FALSE(std::filesystem::exists(out / "roomgraph_unfinished"));
}

}  // namespace
}  // namespace roomgraph::test
