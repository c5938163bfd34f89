// SPDX-License-Identifier: BSD-3-Clause
// The page about a run of an hour is small, and made in little time.
#include <gtest/gtest.h>

#include <chrono>

#include "made_up_run.h"

namespace roomgraph::test {
namespace {

TEST(ReportOfAnHour, IsSmallAndQuick) {
  const TemporaryFolder folder;
  const MadeUpSize hour{3600, 20, 60, 2};
  writeRun(folder, hour);
  const auto before = std::chrono::steady_clock::now();
  const ReportPage page = reportOf(folder);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  EXPECT_LT(page.html.size(), 15e6);
  EXPECT_LT(seconds, 30) << "a few seconds, ten times that where the code is instrumented";
  const json run = dataOf(page)["runs"][0];
  EXPECT_EQ(run["poses"], 72000);
  EXPECT_LE(run["path"].size() / 4, 6000u);
  EXPECT_GT(run["path"].size() / 4, 100u);
  EXPECT_EQ(run["objects"].size(), 62u);
  int sightings = 0;
  for (const json& object : run["objects"])
    if (!object["sightings"].is_null()) sightings += object["sightings"]["count"].get<int>();
  EXPECT_EQ(sightings, 2 * 72000);
  RecordProperty("page_bytes", static_cast<int>(page.html.size()));
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds));
}

}  // namespace
}  // namespace roomgraph::test
