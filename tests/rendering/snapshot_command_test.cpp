// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph snapshot`: files by ending, films, messages, exit codes.
#include <nlohmann/json.hpp>

#include "program.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class SnapshotCommand : public ::testing::Test {
 protected:
  SnapshotCommand() { saveMap(sampleMap(), folder.file("map.rgmap")); }
  CallResult snapshot(std::vector<std::string> words) const {
    words.insert(words.begin(), {"snapshot", folder.file("map.rgmap").string()});
    return call(folder.path(), words);
  }
  std::string file(const std::string& name) const { return folder.file(name).string(); }
  TemporaryFolder folder;
};

TEST_F(SnapshotCommand, TheEndingIsTheFormat) {
  for (const auto& [name, begin] : std::map<std::string, std::string>{{"a.png", "\x89PNG"},
                                                                      {"a.svg", "<?xml"},
                                                                      {"a.pdf", "%PDF"},
                                                                      {"B.PNG", "\x89PNG"},
                                                                      {"C.PDF", "%PDF"}}) {
    for (const char* style : {"screen", "paper"}) {
      const auto result = snapshot({"-o", file(name), "--size", "320x240", "--style", style});
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_THAT(folder.read(name), StartsWith(begin));
    }
  }
}

TEST_F(SnapshotCommand, AFolderOfARunIsItsMap) {
  const auto result = call(folder.path(), {"snapshot", folder.path().string(), "-o", file("a.pdf")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 objects"));
}

TEST_F(SnapshotCommand, FilmsSayWhatTheyAre) {
  const auto result =
      snapshot({"--film", file("frames"), "--size", "160x120", "--fps", "2", "--seconds", "2", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("frames: 8 frames of 160x120 px, 4 s"));
  EXPECT_EQ(result.err, "");
  // Twice real time: two seconds of a recording of 3.9.
  const auto fast =
      snapshot({"--film", file("fast"), "--size", "160x120", "--fps", "2", "--speed", "2", "--quiet"});
  EXPECT_THAT(fast.out, HasSubstr("fast: 8 frames"));
}

TEST_F(SnapshotCommand, WrongUsageIsOneLine) {
  const auto failed = [&](const std::vector<std::string>& words, int code, const std::string& says) {
    const auto result = snapshot(words);
    EXPECT_EQ(result.exit_code, code) << result.out;
    EXPECT_THAT(result.err, HasSubstr(says));
    EXPECT_EQ(linesOf(result.err).size(), 1u) << result.err;
  };
  failed({}, 2, "--output or with --film");
  failed({"-o", file("a.jpg")}, 2, "name it something.png, something.svg or something.pdf");
  failed({"-o", file("a.pdf"), "--view", "orbit"}, 2, ".pdf is drawn from above");
  failed({"-o", file("a.png"), "--view", "robot", "--style", "paper"}, 2, "paper is drawn from above");
  failed({"-o", file("a.png"), "--palette", "pretty"}, 2, "pretty");
  failed({"--film", file("x.avi"), "--fps", "0"}, 2, "--fps");
  failed({"--film", file("x.xyz")}, 2,
         "x.xyz: name it something.mp4, something.webm or something.avi, or name a folder");
  EXPECT_FALSE(std::filesystem::exists(file("x.xyz")));
  failed({"-o", file("missing/a.pdf")}, 1, "missing/a.pdf");
}

TEST_F(SnapshotCommand, FoldersOfFramesMayHaveADotInTheirName) {
  std::filesystem::create_directory(file("frames.v2"));
  const auto result =
      snapshot({"--film", file("frames.v2"), "--size", "64x64", "--fps", "1", "--seconds", "1", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(file("frames.v2") + "/frame_00000.png"));
}

TEST_F(SnapshotCommand, EndingsInCapitalsAreVideosToo) {
  const auto result =
      snapshot({"--film", file("A.AVI"), "--size", "64x64", "--fps", "1", "--seconds", "1", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::is_regular_file(file("A.AVI")));
}

TEST_F(SnapshotCommand, PlansGoOnASheet) {
  const auto plan = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"map", "export", file("map.rgmap"), "-o", file("out"), "--format", "pdf"};
    words.insert(words.end(), more.begin(), more.end());
    return call(folder.path(), words);
  };
  EXPECT_THAT(plan({}).out, HasSubstr("plan.pdf (A4 landscape)"));
  EXPECT_THAT(plan({"--scale", "100", "--page", "A2"}).out, HasSubstr("plan.pdf (A2 landscape)"));
  const auto large = plan({"--scale", "10", "--page", "A4"});
  EXPECT_EQ(large.exit_code, 1);
  EXPECT_THAT(large.err, HasSubstr("--page A1 or --scale 50"));
}

}  // namespace
}  // namespace roomgraph::test
