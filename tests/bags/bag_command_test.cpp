// SPDX-License-Identifier: BSD-3-Clause
// The commands import rosbag, export rosbag and export tum: exit codes, one line for each error, nothing
// partial.
#include "../regression/program.h"
#include "bag_maker.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRoom = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

TEST(BagCommand, ListsAndImports) {
  const TemporaryFolder folder;
  const std::string bag = makeBag(folder).string();
  const auto listed = call(folder.path(), {"import", "rosbag", bag, "--list"});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out,
              HasSubstr("/camera/depth/image_raw  (16UC1 16x12, frame camera_rgb_optical_frame)"));
  EXPECT_THAT(listed.out, HasSubstr("std_msgs/String"));
  for (const char* alias : {"rosbag", "rosbag2"}) {
    const auto imported = call(folder.path(), {"import", alias, bag, "-o", folder.file("x.rawlog").string()});
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    EXPECT_THAT(imported.out, HasSubstr("x.rawlog: 20 'ODOMETRY', 20 'base', 20 'camera_rgb', 20 'laser'\n"));
    EXPECT_THAT(imported.out, HasSubstr("robot: base_footprint\n"));
  }
}

TEST(BagCommand, ErrorsAreOneLineWithTheirCode) {
  const TemporaryFolder folder;
  const std::string bag = makeBag(folder).string(), rawlog = folder.file("x.rawlog").string();
  expectOneLine(call(folder.path(), {"import", "rosbag", bag}), 2, HasSubstr("-o names the rawlog to write"));
  expectOneLine(call(folder.path(), {"import", "rosbag", bag, "-o", rawlog, "--camera", "eye"}), 2,
                HasSubstr("give FX,FY,CX,CY"));
  expectOneLine(call(folder.path(), {"import", "rosbag", bag, "-o", rawlog, "--topic", "/nix"}), 2,
                HasSubstr("no such topic"));
  expectOneLine(call(folder.path(), {"import", "rosbag", bag, "-o", bag}), 2,
                HasSubstr("is read by this import"));
  expectOneLine(call(folder.path(), {"import", "rosbag", kRoom, "-o", rawlog}), 3, HasSubstr("is no bag"));
  expectOneLine(call(folder.path(), {"import", "rosbag", bag, "-o", "/nowhere/x.rawlog"}), 1,
                HasSubstr("there is no folder /nowhere"));
  expectOneLine(call(folder.path(), {"export", "rosbag", bag, "-o", folder.file("y.bag").string()}), 3,
                HasSubstr("x.bag"));
  expectOneLine(call(folder.path(), {"export", "rosbag", kRoom, "-o", "/nowhere/x.bag"}), 1,
                HasSubstr("/nowhere"));
  expectOneLine(call(folder.path(), {"export", "tum", kRoom, "-o", folder.path().string()}), 2,
                HasSubstr("not an empty folder"));
  EXPECT_FALSE(std::filesystem::exists(rawlog));
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.bag")));
}

TEST(BagCommand, ExportsRecordingMapAndFolder) {
  const TemporaryFolder folder;
  const auto bag = call(folder.path(), {"export", "rosbag", kRoom, "-o", folder.file("room.bag").string()});
  EXPECT_EQ(bag.exit_code, 0) << bag.err;
  EXPECT_THAT(bag.out, HasSubstr("/scan"));
  const auto map = call(folder.path(), {"export", "rosbag", ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rgmap",
                                        "-o", folder.file("map.bag").string()});
  EXPECT_EQ(map.exit_code, 0) << map.err;
  EXPECT_THAT(map.out, HasSubstr("/landmarks 1, /map 1, /path 1, /tf"));
  const auto tum = call(folder.path(), {"export", "tum", kRoom, "-o", folder.file("tum").string()});
  EXPECT_EQ(tum.exit_code, 0) << tum.err;
  EXPECT_THAT(tum.out, HasSubstr("import tum --pose"));
}

TEST(BagCommand, InterruptedLeavesNothing) {
  const TemporaryFolder folder;
  const auto bag = makeBag(folder, R"({"seconds": 60})");
  Program program(folder.path(), {"import", "rosbag", bag.string(), "-o", folder.file("x.rawlog").string()});
  while (!std::filesystem::exists(folder.file("x.rawlog.unfinished")) &&
         waitpid(program.pid(), nullptr, WNOHANG) == 0)
    usleep(1000);
  kill(program.pid(), SIGINT);
  const auto outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("x.rawlog was not written"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog.unfinished")));
}

}  // namespace
}  // namespace roomgraph
