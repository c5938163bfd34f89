// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph view` without a display, and with input or options that are wrong: one line and the exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ViewCommand : public testing::Test {
 protected:
  ViewCommand() { saveMap(sampleMap(), folder_.file("map.rgmap")); }
  CallResult view(std::vector<std::string> arguments, const std::string& display = "DISPLAY=") {
    arguments.insert(arguments.begin(), "view");
    return call(folder_.path(), arguments, folder_.path(), {display, "WAYLAND_DISPLAY="});
  }
  TemporaryFolder folder_;
};

TEST_F(ViewCommand, WithoutADisplayOneLineNamesWhatNeedsNone) {
  const auto named = AllOf(HasSubstr("roomgraph snapshot"), HasSubstr("roomgraph report"));
  for (const auto& input : {folder_.file("map.rgmap").string(), folder_.path().string(),
                            std::string(ROOMGRAPH_SOURCE_DIR) + "/rawlogs/tiny_room.rawlog"}) {
    const auto outcome = view({input});
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(linesOf(outcome.err).back(), named) << input;
    EXPECT_EQ(outcome.out, "");
  }
  expectOneLine(view({"map.rgmap"}), 1, named);
  expectOneLine(view({"map.rgmap"}, "DISPLAY=:4711"), 1, named);
}

TEST_F(ViewCommand, InputThatCannotBeRead) {
  expectOneLine(view({"nothing.rgmap"}), 3, HasSubstr("nothing.rgmap"));
  folder_.write("broken.rgmap", "no map");
  expectOneLine(view({"broken.rgmap"}), 3, HasSubstr("broken.rgmap"));
  folder_.write("broken.rawlog", "no recording");
  expectOneLine(view({"broken.rawlog"}), 3, HasSubstr("broken.rawlog"));
  std::filesystem::create_directory(folder_.file("empty"));
  expectOneLine(view({"empty"}), 3, HasSubstr("map.rgmap"));
}

TEST_F(ViewCommand, OptionsThatMakeNoSense) {
  expectOneLine(view({"map.rgmap", "--size", "12"}), 2, HasSubstr("--size 12"));
  expectOneLine(view({"map.rgmap", "--size", "10x10"}), 2, HasSubstr("64 to 8192"));
  expectOneLine(view({"map.rgmap", "--save", "picture.gif"}), 2, HasSubstr("PNG"));
  expectOneLine(view({"map.rgmap", "--speed", "-1"}), 2, HasSubstr("--speed"));
  expectOneLine(view({"map.rgmap", "--top", "--follow"}), 2, HasSubstr("--top"));
  expectOneLine(view({"map.rgmap", "--from", "3", "--until", "2"}), 2, HasSubstr("--until"));
  expectOneLine(view({"map.rgmap", "--set", "lidar.enabled=false"}), 2, HasSubstr("for a recording"));
  expectOneLine(view({}), 2, HasSubstr("INPUT"));
}

}  // namespace
}  // namespace roomgraph::test
