// SPDX-License-Identifier: BSD-3-Clause
// result.json there and back, and numbers of other reports.
#include "roomgraph/catalogue/run_result.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "made_up_results.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

TEST(RunResultFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const RunResult before = madeUpResult("lab", 3, "default");
  writeRunResult(before, folder.file("result.json"));
  const RunResult r = readRunResult(folder.file("result.json"));
  EXPECT_EQ(r.name, before.name);
  EXPECT_EQ(r.variant, before.variant);
  EXPECT_EQ(r.status, before.status);
  EXPECT_EQ(r.key, before.key);
  EXPECT_EQ(r.evaluation_key, before.evaluation_key);
  EXPECT_EQ(r.input.name, before.input.name);
  EXPECT_EQ(r.input.group, before.input.group);
  EXPECT_EQ(r.input.seed, before.input.seed);
  EXPECT_EQ(r.input.path, before.input.path);
  EXPECT_EQ(r.input.sha256, before.input.sha256);
  EXPECT_EQ(r.input.bytes, before.input.bytes);
  EXPECT_EQ(r.version + r.revision + r.program + r.keep + r.started,
            before.version + before.revision + before.program + before.keep + before.started);
  EXPECT_EQ(r.parameters, before.parameters);
  EXPECT_EQ(r.command, before.command);
  EXPECT_EQ(r.figures, before.figures);
  EXPECT_EQ(r.files, before.files);
  EXPECT_EQ(r.wall_s, before.wall_s);
  EXPECT_EQ(r.cpu_s, before.cpu_s);
  EXPECT_EQ(r.peak_memory_mb, before.peak_memory_mb);
  ASSERT_EQ(r.timings.size(), 1u);
  EXPECT_EQ(r.timings.at("association").calls, 41);
  EXPECT_EQ(r.timings.at("association").max_ms, 0.5);
  ASSERT_EQ(r.failures.size(), 1u);
  EXPECT_EQ(r.failures[0].exit_code, 137);
  EXPECT_EQ(r.failures[0].reason, "killed");
}

TEST(RunResultFile, WithoutASeedThereIsNone) {
  const TemporaryFolder folder;
  RunResult result = madeUpResult("lab", 3, "default");
  result.input.seed.reset();
  writeRunResult(result, folder.file("result.json"));
  EXPECT_FALSE(readRunResult(folder.file("result.json")).input.seed);
}

TEST(RunResultFile, WhatIsWrongIsNamedWithTheFile) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& text) {
    return messageOf<InputError>([&] { readRunResult(folder.write("result.json", text)); });
  };
  EXPECT_THAT(problem("{\"format\": "), HasSubstr("result.json"));
  EXPECT_THAT(problem("{\"format\": \"other\", \"format_version\": 1}"),
              HasSubstr("no result of this version"));
  EXPECT_THAT(problem("{\"format\": \"roomgraph run result\", \"format_version\": 1}"), HasSubstr("'name'"));
}

TEST(RunResultFile, NumbersOfAReportKeepTheirPlaces) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "objects.json",
      R"({"f1": 0.5, "yaw": null, "name": "x", "per_class": {"sofa": {"correct": 2}}, "list": [1]})");
  EXPECT_THAT(numbersOf(file, "objects"),
              ::testing::ElementsAre(::testing::Pair("objects.f1", 0.5),
                                     ::testing::Pair("objects.per_class.sofa.correct", 2.0)));
}

}  // namespace
}  // namespace roomgraph::test
