// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph map diff` and `roomgraph map merge`.
#include <nlohmann/json.hpp>

#include "program.h"
#include "roomgraph/mapping/map_files.h"
#include "temporary_folder.h"
#include "two_sessions.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class MapCompare : public ::testing::Test {
 protected:
  MapCompare() {
    saveMap(sessionMap(flatWalls(), flatObjects(), {0, 0, 0}, 1000), file("a.rgmap"));
    auto later = flatObjects();
    later.erase(later.begin());
    saveMap(sessionMap(flatWalls(), later, {2, -1, 2.2}, 5000), file("b.rgmap"));
    saveMap(sessionMap(otherWalls(), {}, {0, 0, 0}), file("other.rgmap"));
  }
  std::string file(const std::string& name) const { return folder.file(name).string(); }
  CallResult map(std::vector<std::string> words) const {
    words.insert(words.begin(), "map");
    return call(folder.path(), words);
  }
  TemporaryFolder folder;
};

TEST_F(MapCompare, DiffSaysWhatIsGone) {
  const auto result =
      map({"diff", file("a.rgmap"), file("b.rgmap"), "--json", file("d.json"), "--svg", file("d.svg")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* words : {"vanished", "swivel_chair", "5 objects stayed", "turned by -126.1 deg"})
    EXPECT_THAT(result.out, HasSubstr(words));
  const auto json = nlohmann::json::parse(folder.read("d.json"));
  EXPECT_EQ(json["objects"].size(), 6u);
  EXPECT_THAT(folder.read("d.svg"), HasSubstr("vanished"));
}

TEST_F(MapCompare, MergeIsAMapInTheFirstFrame) {
  const auto result = map({"merge", file("a.rgmap"), file("b.rgmap"), "-o", file("all.rgmap")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const CSemanticMap all = loadMap(file("all.rgmap"));
  EXPECT_EQ(all.landmarks.size(), 5u);
  for (const auto& object : all.landmarks)
    for (const auto& truth : flatObjects())
      if (truth.id == object.id) {
        EXPECT_LT((truth.position - object.position).norm(), 0.04);
      }
  EXPECT_EQ(all.world_from_robot.size(), 10u);
  EXPECT_THAT(all.provenance.history.back(), HasSubstr("united with the map of session at 5000"));
}

TEST_F(MapCompare, UnsureIsRefusedWithAReason) {
  for (const std::string verb : {"diff", "merge"}) {
    std::vector<std::string> words{verb, file("a.rgmap"), file("other.rgmap")};
    if (verb == "merge") words.insert(words.end(), {"-o", file("x.rgmap")});
    expectOneLine(map(words), 1, ::testing::AllOf(HasSubstr("no certain place"), HasSubstr("--same-frame")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("x.rgmap")));
  expectOneLine(map({"merge", file("a.rgmap"), "-o", file("x.rgmap")}), 2, HasSubstr("two maps"));
  expectOneLine(map({"merge", file("a.rgmap"), file("b.rgmap"), "-o", file("a.rgmap")}), 2,
                HasSubstr("is read by"));
  expectOneLine(map({"diff", file("a.rgmap"), file("none.rgmap")}), 3, HasSubstr("no such file"));
  EXPECT_THAT(map({"diff", file("a.rgmap"), file("a.rgmap"), "--same-frame"}).out,
              HasSubstr("6 objects stayed"));
  for (const std::string verb : {"diff", "merge"})
    EXPECT_THAT(map({verb, "--help"}).out, HasSubstr("Example"));
}

}  // namespace
}  // namespace roomgraph::test
