// SPDX-License-Identifier: BSD-3-Clause
// A finished run over time from made-up files, with files missing and broken; a map alone.
#include "roomgraph/viewer/recorded_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "errors_of.h"
#include "made_up_states.h"
#include "roomgraph/core/base64.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/viewer/timeline.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;

/// The sample map with a candidate (9), sightings of 1 from 1 s and of 2 from 2 s on, none of 7.
class Recorded : public testing::Test {
 protected:
  Recorded() {
    saveMap(map_, folder_.file("map.rgmap"));
    auto candidates = map_.landmarks;
    candidates.push_back(sampleLandmark(9, "sofa", ShapeKind::kCuboid, 0, 1));
    candidates.back().existence = 0.2;
    saveLandmarksJson(candidates, folder_.file("candidates.json"),
                      {.evidence = {{LandmarkId{1}, {{"label", 0.75}}}, {LandmarkId{9}, {{"filter", -2}}}}});
    writeAssociations();
    folder_.write(
        "detections.jsonl",
        "{\"timestamp\": 1000.5, \"boxes\": [{\"class\": \"sofa\", \"score\": 0.5, \"bbox\": [1, 2, 30, "
        "40]}]}\n"
        "{\"timestamp\": 1002, \"boxes\": [{\"class\": \"door\", \"score\": 0.6, \"bbox\": [5, 6, 7, 8], "
        "\"carried\": true}]}\n");
    folder_.write("views.jsonl", json{{"id", 2}, {"jpeg", toBase64("picture")}}.dump() + "\n");
    folder_.write(
        "graph.g2o",
        "VERTEX_SE2 0 0 0 0\n# STAMP 0 1000\nVERTEX_SE2 1 1 0 0\n# STAMP 1 1001\nVERTEX_SE2 2 2 0 0\n"
        "# STAMP 2 1002.5\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 2 2 0 0 1 0 0 1 0 1\n");
    folder_.write("summary.json", "{\"input\": \"sample.rawlog\"}");
  }

  void writeAssociations() {
    std::string lines;
    for (int i = 0; i < 30; ++i) {
      json measurements = json::array();
      for (const int id : {1, 2})
        if (i >= 10 * id)
          measurements.push_back({{"landmark", id},
                                  {"new", i == 10 * id},
                                  {"posterior",
                                   {{{"landmark", i == 10 * id ? json("new") : json(id)}, {"p", 0.9}},
                                    {{"landmark", 7}, {"p", 0.1}}}},
                                  {"confidence", 0.5},
                                  {"score", 0.25},
                                  {"source", "depth"},
                                  {"energy", {{"unary", 1}, {"pairwise", 2}, {"high_order", 3}}}});
      lines += json{{"timestamp", 1000 + 0.1 * i}, {"measurements", measurements}}.dump() + "\n";
    }
    folder_.write("associations.jsonl", lines);
  }

  static std::vector<std::int64_t> idsIn(const ViewState& state) {
    std::vector<std::int64_t> ids;
    for (const auto& shown : *state.landmarks) ids.push_back(shown->landmark.id.value);
    return ids;
  }

  CSemanticMap map_ = sampleMap();
  TemporaryFolder folder_;
};

TEST_F(Recorded, HasAStateForEveryPose) {
  const RecordedRun run = readRecordedRun(folder_.path());
  EXPECT_THAT(run.warnings, testing::IsEmpty());
  ASSERT_EQ(run.states.size(), map_.world_from_robot.size());
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    EXPECT_EQ(run.states[i]->record, static_cast<int>(i) + 1);
    EXPECT_DOUBLE_EQ(run.states[i]->t, map_.world_from_robot[i].t);
    EXPECT_TRUE(run.states[i]->world_from_robot.isApprox(map_.world_from_robot[i].pose, 1e-6));
    EXPECT_EQ(run.states[i]->path->size(), run.states.size());
    EXPECT_TRUE(run.states[i]->grid);
  }
  EXPECT_EQ(run.recording, "sample.rawlog");
  EXPECT_EQ(run.views.at(LandmarkId{2}), "picture");
}

TEST_F(Recorded, LandmarksComeIntoViewWhenTheyWereFirstSeen) {
  const RecordedRun run = readRecordedRun(folder_.path());
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(idsIn(*run.states[0]), (Ids{7, 9})) << "never seen in this run: of an earlier map";
  EXPECT_EQ(idsIn(*run.states[15]), (Ids{1, 7, 9}));
  EXPECT_EQ(idsIn(*run.states[39]), (Ids{1, 2, 7, 9}));
  EXPECT_EQ(run.states[15]->landmarks, run.states[18]->landmarks) << "shared";
  EXPECT_TRUE(findLandmark(*run.states[39], LandmarkId{1})->in_map);
  EXPECT_FALSE(findLandmark(*run.states[39], LandmarkId{9})->in_map);
  EXPECT_EQ(findLandmark(*run.states[39], LandmarkId{1})->evidence.at("label"), 0.75);
  EXPECT_EQ(findLandmark(*run.states[39], LandmarkId{9})->landmark.existence, 0.2);
}

TEST_F(Recorded, SightingsHavePosteriorsAndEnergies) {
  Timeline timeline;
  timeline.add(readRecordedRun(folder_.path()).states);
  const auto sightings = timeline.sightingsOf(LandmarkId{1});
  ASSERT_EQ(sightings.size(), 20u);
  EXPECT_TRUE(sightings.front().made_new);
  EXPECT_DOUBLE_EQ(sightings.front().probability, 0.9) << "of being new";
  EXPECT_FALSE(sightings.back().made_new);
  EXPECT_DOUBLE_EQ(sightings.back().probability, 0.9);
  EXPECT_EQ(sightings.back().posterior.size(), 2u);
  EXPECT_EQ(sightings.back().energy.pairwise, 2);
  EXPECT_EQ(sightings.back().source, "depth");
  timeline.seekTime(1001.55);
  EXPECT_EQ(timeline.sightingsOf(LandmarkId{1}).size(), 6u);
}

TEST_F(Recorded, BoxesAndClosuresAreThoseOfTheirTimes) {
  const RecordedRun run = readRecordedRun(folder_.path());
  EXPECT_EQ(run.states[4]->frame, nullptr) << "before the first frame";
  ASSERT_TRUE(run.states[5]->frame);
  EXPECT_EQ(run.states[5]->frame->detections.boxes.at(0).class_name, "sofa");
  EXPECT_EQ(run.states[19]->frame->t, 1000.5) << "the last frame until then";
  const auto& door = run.states[20]->frame->detections.boxes.at(0);
  EXPECT_TRUE(door.carried);
  EXPECT_EQ(door.box, (Box2{5, 6, 7, 8}));
  ASSERT_EQ(run.states[0]->closures->size(), 1u) << "not the edge between neighbours";
  EXPECT_DOUBLE_EQ(run.states[0]->closures->at(0).t_a, 1000);
  EXPECT_DOUBLE_EQ(run.states[0]->closures->at(0).t_b, 1002.5);
}

TEST_F(Recorded, AFileThatIsMissingOrBrokenCostsWhatIsInIt) {
  const std::map<std::string, std::string> parts{
      {"candidates.json", "candidates"}, {"associations.jsonl", "sightings"},
      {"graph.g2o", "loop closures"},    {"detections.jsonl", "boxes"},
      {"views.jsonl", "views"},          {"summary.json", "camera images"}};
  for (const auto& [name, what] : parts) {
    const std::string content = folder_.read(name);
    std::filesystem::remove(folder_.file(name));
    RecordedRun run = readRecordedRun(folder_.path());
    EXPECT_THAT(run.warnings, testing::ElementsAre(testing::AllOf(HasSubstr(name), HasSubstr("no " + what))))
        << name;
    EXPECT_EQ(run.states.size(), 40u);
    if (name != "graph.g2o") {  // lines that are none of the format are stepped over
      folder_.write(name, "{\"timestamp\": \n[");
      run = readRecordedRun(folder_.path());
      EXPECT_THAT(run.warnings, testing::ElementsAre(HasSubstr(name))) << name;
    }
    EXPECT_GE(run.states.back()->landmarks->size(), 3u) << "those of the map, in any case";
    folder_.write(name, content);
  }
}

TEST_F(Recorded, AWarningNamesTheLine) {
  folder_.write("associations.jsonl", "\n" + folder_.read("associations.jsonl") + "{\"timestamp\": 3}\n");
  EXPECT_THAT(readRecordedRun(folder_.path()).warnings, Contains(HasSubstr("associations.jsonl:32: ")));
  writeAssociations();
  folder_.write("candidates.json", "{\"landmarks\": [{\"id\": 1}]}");
  EXPECT_THAT(readRecordedRun(folder_.path()).warnings, Contains(HasSubstr("object 1: ")));
}

TEST_F(Recorded, WithoutAMapThereIsNothingToShow) {
  std::filesystem::remove(folder_.file("map.rgmap"));
  EXPECT_THAT(messageOf<InputError>([&] { readRecordedRun(folder_.path()); }), HasSubstr("map.rgmap"));
}

TEST(StatesOfMap, OneStateWithEverything) {
  const auto states = statesOfMap(sampleMap());
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0]->record, 0) << "nothing is played";
  EXPECT_EQ(states[0]->landmarks->size(), 3u);
  EXPECT_DOUBLE_EQ(states[0]->t, 1003.9);
  const auto empty = statesOfMap(CSemanticMap{});
  EXPECT_EQ(empty.at(0)->record, 0);
  EXPECT_TRUE(empty.at(0)->landmarks->empty());
}

}  // namespace
}  // namespace roomgraph::test
