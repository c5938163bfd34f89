// SPDX-License-Identifier: BSD-3-Clause
// The command damage: what it prints, exit codes, and that other commands read what it wrote.
#include "../regression/program.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTinyRoom = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

TEST(DamageCommand, PrintsWhatEachFaultTouchedInTheOrderOfTheCommandLine) {
  const TemporaryFolder folder;
  const std::string out = folder.file("y.rawlog").string();
  const auto done = call(folder.path(), {"damage", kTinyRoom, "-o", out, "--drop-lidar", "2:4", "--black",
                                         "1:2", "--drop-lidar", "6:7", "--duplicate", "odometry=3:4"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto lines = linesOf(done.out);
  ASSERT_EQ(lines.size(), 5u) << done.out;
  EXPECT_EQ(lines[0], "--drop-lidar 2:4: 10 'LIDAR'");  // 5 Hz for 2 s
  EXPECT_EQ(lines[1], "--black 1:2: 5 'DETECTIONS', 5 'KINECT'");
  EXPECT_EQ(lines[2], "--drop-lidar 6:7: 5 'LIDAR'");
  EXPECT_EQ(lines[3], "--duplicate odometry=3:4: 10 'ODOMETRY'");
  EXPECT_THAT(lines[4], HasSubstr("y.rawlog: "));
  const auto info = call(folder.path(), {"info", out});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("LIDAR: gap of 2."));
}

TEST(DamageCommand, TheSameSeedGivesTheSameFile) {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  for (const char* seed : {"3", "3", "4"}) {
    const auto out = folder.file("y" + std::to_string(files.size()) + ".rawlog");
    const auto done =
        call(folder.path(), {"damage", kTinyRoom, "-o", out.string(), "--noise", "lidar=0:", "--seed", seed});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    files.push_back(contentOf(out));
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_NE(files[0], files[2]);
}

TEST(DamageCommand, ErrorsAreOneLineWithTheirCode) {
  const TemporaryFolder folder;
  const std::string out = folder.file("y.rawlog").string();
  const auto damage = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "damage");
    return call(folder.path(), words);
  };
  expectOneLine(damage({kTinyRoom, "-o", out}), 2, HasSubstr("no fault is asked for"));
  expectOneLine(damage({kTinyRoom, "-o", out, "--drop-lidar", "100:200"}), 2,
                HasSubstr("--drop-lidar 100:200: touches no record"));
  expectOneLine(damage({kTinyRoom, "-o", out, "--drop-lidar", "20"}), 2, HasSubstr("expected A:B"));
  expectOneLine(damage({kTinyRoom, "-o", out, "--drop-wheels", "1:2"}), 2, HasSubstr("--drop-wheels"));
  expectOneLine(damage({kTinyRoom, "--drop-lidar", "1:2"}), 2, HasSubstr("--output"));
  expectOneLine(damage({"nowhere.rawlog", "-o", out, "--drop-lidar", "1:2"}), 3,
                HasSubstr("nowhere.rawlog: no such file"));
  expectOneLine(damage({kTinyRoom, "-o", "/nowhere/y.rawlog", "--drop-lidar", "1:2"}), 1,
                HasSubstr("/nowhere"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(DamageCommand, HelpListsFaultsWithExamples) {
  const TemporaryFolder folder;
  const auto help = call(folder.path(), {"damage", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* text : {"--kidnap A:B", "--clock-jump [SENSOR=]A:SECONDS", "Examples:", "--seed"})
    EXPECT_THAT(help.out, HasSubstr(text));
}

}  // namespace
}  // namespace roomgraph
