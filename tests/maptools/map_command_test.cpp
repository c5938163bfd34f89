// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph map …`: files, exit codes, messages.
#include <nlohmann/json.hpp>

#include "program.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

class MapCommand : public ::testing::Test {
 protected:
  MapCommand() {
    CSemanticMap map = sampleMap();
    map.views.resize(2);
    map.provenance = {
        "roomgraph test", "[x]\n", "[sofa]\nlabels = sofa\ncolor = #010203\n", {"run of sample.rawlog"}};
    saveMap(map, file("map.rgmap"));
  }
  std::string file(const std::string& name) const { return folder.file(name).string(); }
  CallResult map(std::vector<std::string> words) const {
    words.insert(words.begin(), "map");
    return call(folder.path(), words);
  }
  TemporaryFolder folder;
};

TEST_F(MapCommand, InfoSaysWhatIsInside) {
  const auto result = map({"info", file("map.rgmap"), "--json", file("info.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* text :
       {"120 x 80 cells", "3 objects: ", "1 sofa", "40 poses", "re-localise by: 2; configuration: kept",
        "roomgraph test", "history: run of sample.rawlog"})
    EXPECT_THAT(result.out, HasSubstr(text));
  const auto json = nlohmann::json::parse(folder.read("info.json"));
  EXPECT_EQ(json["objects_by_class"]["sofa"], 1);
  EXPECT_EQ(json["config"], "[x]\n");
  EXPECT_EQ(json["image_views"], 2);
  // 116 x 76 free cells, walls of two cells.
  EXPECT_NEAR(json["free_m2"].get<double>(), 116 * 76 * 0.0025, 1e-3);
  EXPECT_NEAR(json["occupied_m2"].get<double>(), (120 * 80 - 116 * 76) * 0.0025, 1e-3);
}

TEST_F(MapCommand, ExportWritesAllOrWhatIsNamed) {
  const auto all = map({"export", file("map.rgmap"), "-o", file("all")});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  for (const char* name :
       {"map.yaml", "map.pgm", "semantic.pgm", "semantic_legend.json", "keepout.yaml", "objects.geojson",
        "objects.csv", "map.ply", "plan.svg", "plan.dxf", "map.3Dscene"})
    EXPECT_TRUE(std::filesystem::exists(folder.file("all") / name)) << name;
  EXPECT_THAT(contentOf(folder.file("all") / "plan.svg"), HasSubstr("#010203")) << "the map's own colours";
  EXPECT_EQ(map({"export", file("map.rgmap"), "-o", file("two"), "--format", "csv,dxf"}).exit_code, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("two")), {}), 2);
}

TEST_F(MapCommand, CropWritesAMap) {
  const auto result = map({"crop", file("map.rgmap"), "-o", file("part.rgmap"), "--box", "-1,0,2,2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const CSemanticMap part = loadMap(file("part.rgmap"));
  EXPECT_EQ(part.landmarks.size(), 1u);
  EXPECT_THAT(part.provenance.program, ::testing::StartsWith("roomgraph 0"));
  EXPECT_EQ(part.provenance.config, "[x]\n");
}

TEST_F(MapCommand, WrongUseIsExplained) {
  expectOneLine(map({"info", file("none.rgmap")}), 3, HasSubstr("none.rgmap: no such file"));
  expectOneLine(map({"crop", file("map.rgmap"), "-o", file("x")}), 2, HasSubstr("--box or with --polygon"));
  expectOneLine(map({"crop", file("map.rgmap"), "-o", file("x"), "--box=1,1,0,2"}), 2, HasSubstr("minima"));
  expectOneLine(map({"crop", file("map.rgmap"), "-o", file("x"), "--polygon=0,0,1,1"}), 2,
                HasSubstr("three corners"));
  expectOneLine(map({"crop", file("map.rgmap"), "-o", file("map.rgmap"), "--box=0,0,1,1"}), 2,
                HasSubstr("is read by"));
  expectOneLine(map({"export", file("map.rgmap"), "-o", file("x"), "--margin", "sofa=far"}), 2,
                HasSubstr("CLASS=METRES"));
  expectOneLine(map({"export", file("map.rgmap"), "-o", file("x"), "--margin", "sofaa=0.3"}), 2,
                HasSubstr("--margin sofaa: no such class (did you mean 'sofa'?)"));
  expectOneLine(map({"export", file("map.rgmap"), "-o", file("x"), "--format", "obj"}), 2, HasSubstr("obj"));
  expectOneLine(map({"export", file("map.rgmap"), "-o", file("map.rgmap")}), 1,
                HasSubstr("cannot make the folder"));
  expectOneLine(map({}), 2, HasSubstr("subcommand"));
  for (const std::string name : {"info", "export", "crop"})
    EXPECT_THAT(map({name, "--help"}).out, HasSubstr("Example")) << name;
}

}  // namespace
}  // namespace roomgraph::test
