// SPDX-License-Identifier: BSD-3-Clause
// Missing and broken files cost their section; folders of no run are errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_up_run.h"
#include "roomgraph/core/errors.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

const std::vector<std::string> kFiles{"trajectory.tum",  "live.tum",           "landmarks.json",
                                      "candidates.json", "objects.ini",        "summary.json",
                                      "timings.csv",     "associations.jsonl", "map.yaml",
                                      "graph.g2o",       "config.ini"};

class EachFile : public ::testing::TestWithParam<std::string> {};

TEST_P(EachFile, MissingIsNamedAndTheRestIsThere) {
  const TemporaryFolder folder;
  writeRun(folder);
  std::filesystem::remove(folder.file(GetParam()));
  const ReportPage page = reportOf(folder);
  const json run = dataOf(page)["runs"][0];
  EXPECT_EQ(run["missing"], (json{{GetParam(), "is not there"}}));
  ASSERT_THAT(page.warnings, SizeIs(1));
  EXPECT_EQ(page.warnings[0], folder.file(GetParam()).string() + ": is not there");
  EXPECT_EQ(run["objects"].size(), GetParam() == "landmarks.json"    ? 5u
                                   : GetParam() == "candidates.json" ? 3u
                                                                     : 5u);
  EXPECT_EQ(run["path"].empty(), GetParam() == "trajectory.tum");
}

// Cut in the middle, filled with noise, emptied, and a folder in its place.
TEST_P(EachFile, BrokenIsNoCrash) {
  const TemporaryFolder folder;
  writeRun(folder);
  const std::string whole = folder.read(GetParam());
  std::string noise(3000, 0);
  unsigned state = 7;
  for (char& c : noise) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  for (const std::string& content :
       {whole.substr(0, whole.size() / 2), noise, std::string(), std::string("{\"landmarks\": [3]}"),
        std::string("[1, {\"counts\": \"x\"}]"), std::string("null")}) {
    folder.write(GetParam(), content);
    const json run = dataOf(reportOf(folder))["runs"][0];
    for (const auto& [name, cause] : run["missing"].items()) {
      EXPECT_EQ(name, GetParam());
      EXPECT_EQ(cause.get<std::string>().find('\n'), std::string::npos) << cause;
    }
  }
  std::filesystem::remove(folder.file(GetParam()));
  std::filesystem::create_directory(folder.file(GetParam()));
  EXPECT_TRUE(dataOf(reportOf(folder))["runs"][0]["missing"].contains(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(ReportFiles, EachFile, ::testing::ValuesIn(kFiles), [](const auto& file) {
  std::string name = file.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

std::string causeOf(const TemporaryFolder& folder, const std::string& file) {
  return runOf(folder)["missing"].value(file, "(nothing is wrong)");
}

TEST(ReportErrors, ARunWithoutACameraHasNoPathOfOne) {
  const TemporaryFolder folder;
  writeRun(folder);
  folder.write("trajectory_camera.tum", "");
  EXPECT_EQ(causeOf(folder, "trajectory_camera.tum"), "(nothing is wrong)");
  folder.write("trajectory_camera.tum", "1 2\n");
  EXPECT_NE(causeOf(folder, "trajectory_camera.tum"), "(nothing is wrong)");
}

TEST(ReportErrors, TheCauseNamesThePlace) {
  const TemporaryFolder folder;
  writeRun(folder);
  json content = json::parse(folder.read("landmarks.json"));
  content["landmarks"][1].erase("size_wdh");
  folder.write("landmarks.json", content.dump());
  EXPECT_THAT(causeOf(folder, "landmarks.json"), HasSubstr("object 2: "));
  folder.write("timings.csv", "timestamp,stage,ms,cpu_ms\n1,a,2,3\n1,a,two,3\n");
  EXPECT_EQ(causeOf(folder, "timings.csv"), "timings.csv:3: expected timestamp,stage,ms,cpu_ms");
  folder.write("timings.csv", "timestamp,stage,ms,cpu_ms,memory_mb\n1,a, b,2,3,4\n1,2,3,4\n");
  EXPECT_EQ(causeOf(folder, "timings.csv"), "timings.csv:3: expected timestamp,stage,ms,cpu_ms,memory_mb");
  folder.write("lost.jsonl", "{\"sensor\": \"camera\", \"from\": 1}\n");
  EXPECT_EQ(causeOf(folder, "lost.jsonl"), "lost.jsonl:1: is no span of a sensor");
  folder.write("associations.jsonl", "\n{\"timestamp\": 1, \"measurements\": [{}]}\n");
  EXPECT_THAT(causeOf(folder, "associations.jsonl"), HasSubstr("associations.jsonl:2: "));
  folder.write("trajectory.tum", "1 2 3\n");
  EXPECT_THAT(causeOf(folder, "trajectory.tum"), HasSubstr("1"));
  folder.write("views.jsonl", "{\"id\": 1, \"jpeg\": \"AAAA\"}\n{\"id\": 2, \"jpeg\": \"</script>\"}\n");
  EXPECT_EQ(causeOf(folder, "views.jsonl"), "views.jsonl:2: is no view of a landmark");
}

TEST(ReportErrors, FoldersOfNoRunAreRefused) {
  const TemporaryFolder folder;
  const auto messageOf = [](const std::filesystem::path& place) -> std::string {
    try {
      makeReport({{{place, "x"}}, {}, {}});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(messageOf(folder.file("none")), HasSubstr("is no folder of a run"));
  EXPECT_THAT(messageOf(folder.path()), HasSubstr("has no file of a run"));
  writeRun(folder);
  EXPECT_EQ(messageOf(folder.path()), "");
  EXPECT_THROW(reportOf(folder, folder.file("truth.tum")), InputError);
}

TEST(ReportErrors, ATruthOfAnotherTimeIsAWarning) {
  const TemporaryFolder folder;
  writeRun(folder);
  folder.write("truth.tum", "5 0 0 0 0 0 0 1\n6 0 0 0 0 0 0 1\n");
  const ReportPage page = reportOf(folder, folder.file("truth.tum"));
  ASSERT_THAT(page.warnings, SizeIs(1));
  EXPECT_THAT(page.warnings[0], HasSubstr("no pose of made up has a true one"));
  EXPECT_TRUE(dataOf(page)["runs"][0]["final_errors"].is_null());
}

}  // namespace
}  // namespace roomgraph::test
