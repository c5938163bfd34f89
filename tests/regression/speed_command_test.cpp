// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph bench speed`: its table and its JSON, and what it does not take.
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kRoom = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

TEST(SpeedCommand, TellsStagesLatencyAndMemory) {
  TemporaryFolder folder;
  const auto file = folder.file("speed.json");
  const CallResult result =
      call(folder.path(), {"bench", "speed", kRoom, "--json", file.string(), "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("x real time"), HasSubstr("RGB-D odometry"), HasSubstr("scans")));
  const auto speed = nlohmann::json::parse(contentOf(file));
  EXPECT_NEAR(speed["recorded_s"], 8, 0.2);
  EXPECT_GT(speed["wall_s"], speed["end_s"]);
  EXPECT_GT(speed["peak_memory_mb"], 20);
  EXPECT_EQ(speed["latency"]["frames"]["count"], 41);
  EXPECT_EQ(speed["latency"]["scans"]["count"], 40);
  for (const auto& stage : speed["stages"]) {
    EXPECT_GE(stage["max_ms"], stage["p99_ms"]) << stage["stage"];
    EXPECT_GE(stage["p99_ms"], stage["median_ms"]) << stage["stage"];
  }
}

TEST(SpeedCommand, OneThreadDoesAllByItself) {
  TemporaryFolder folder;
  const auto file = folder.file("speed.json");
  ASSERT_EQ(call(folder.path(), {"bench", "speed", kRoom, "--threads", "1", "--until", "2", "--json",
                                 file.string(), "--quiet"})
                .exit_code,
            0);
  const auto speed = nlohmann::json::parse(contentOf(file));
  EXPECT_NEAR(speed["recorded_s"], 2, 0.2);
  EXPECT_EQ(speed["threads"], 1);
  for (const auto& stage : speed["stages"]) EXPECT_NE(stage["stage"], "foreseeing");
}

TEST(SpeedCommand, WhatCannotBeReadIsNamed) {
  TemporaryFolder folder;
  expectOneLine(call(folder.path(), {"bench", "speed", "none.rawlog"}), 3, HasSubstr("none.rawlog"));
  expectOneLine(call(folder.path(), {"bench", "speed", kRoom, "--json", kRoom}), 2,
                HasSubstr("tiny_room.rawlog"));
  expectOneLine(call(folder.path(), {"bench", "speed", kRoom, "--from", "1000", "--quiet"}), 3,
                HasSubstr("no record"));
}

}  // namespace
}  // namespace roomgraph::test
