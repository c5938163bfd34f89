// SPDX-License-Identifier: BSD-3-Clause
// Plans: every combination once, names that are unique and stay, truth that is found.
#include "roomgraph/batch/plan.h"

#include <gmock/gmock.h>

#include <fstream>
#include <random>
#include <set>

#include "errors_of.h"
#include "roomgraph/catalogue/run_result.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/truth_file.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class Plans : public ::testing::Test {
 protected:
  void touch(const std::string& name) const {
    std::filesystem::create_directories(folder.file(name).parent_path());
    folder.write(name, name);
  }
  std::vector<std::string> inputNames(const std::vector<std::string>& patterns) const {
    std::vector<std::string> absolute, names;
    for (const auto& pattern : patterns) absolute.push_back(folder.file(pattern).string());
    for (const auto& input : planBatch(jobsOfRecordings(absolute), folder.file("out")).inputs)
      names.push_back(input.input.name);
    return names;
  }
  const TemporaryFolder folder;
};

// Random numbers of inputs, seeds and variants: each pair of input and variant is there once, and no other.
TEST_F(Plans, HoldEveryCombinationOnce) {
  std::mt19937 random(2);
  for (int i = 0; i < 6; ++i) touch("r" + std::to_string(i) + ".rawlog");
  touch("w.json");
  for (int trial = 0; trial < 40; ++trial) {
    JobFile jobs;
    std::set<std::string> inputs, expected, runs;
    const int recordings = static_cast<int>(random() % 6), seeds = 1 + static_cast<int>(random() % 4),
              variants = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < recordings; ++i) {
      jobs.inputs.push_back({.patterns = {folder.file("r" + std::to_string(i) + ".rawlog").string()}});
      inputs.insert("r" + std::to_string(i));
    }
    InputEntry world;
    world.simulated.emplace().world = folder.file("w.json");
    for (int s = 0; s < seeds; ++s) {
      world.simulated->seeds.push_back(s);
      inputs.insert("w_s" + std::to_string(s));
    }
    jobs.inputs.push_back(world);
    jobs.variants.clear();
    for (int v = 0; v < variants; ++v) {
      jobs.variants.push_back({.name = "v" + std::to_string(v)});
      for (const auto& input : inputs) expected.insert(input + "--v" + std::to_string(v));
    }
    const BatchPlan plan = planBatch(jobs, folder.file("out"));
    for (const auto& run : plan.runs) {
      runs.insert(run.name);
      EXPECT_EQ(run.name, plan.inputs[run.input].input.name + "--" + plan.variants[run.variant].name);
    }
    EXPECT_EQ(runs, expected);
    EXPECT_EQ(plan.runs.size(), expected.size());
  }
}

TEST_F(Plans, NamesAreThoseOfTheFilesWithAsManyFoldersAsItTakes) {
  for (const char* name :
       {"a/lab.rawlog", "b/lab.rawlog", "b/hall one.rawlog.gz", "b/x/lab.rawlog", "c/x/lab.rawlog"})
    touch(name);
  EXPECT_THAT(inputNames({"a/*.rawlog"}), ElementsAre("lab"));
  EXPECT_THAT(inputNames({"?/*.rawlog*"}), UnorderedElementsAre("a_lab", "b_lab", "hall_one"));
  EXPECT_THAT(inputNames({"a/lab.rawlog", "b/x/lab.rawlog", "c/x/lab.rawlog"}),
              UnorderedElementsAre("a_lab", "b_x_lab", "c_x_lab"));
  EXPECT_THAT(inputNames({"a/lab.rawlog", "a/*.rawlog"}), ElementsAre("lab")) << "one file, named twice";
}

TEST_F(Plans, ANameInTheFolderStaysWithItsRecording) {
  for (const char* name : {"a/lab.rawlog", "b/lab.rawlog"}) touch(name);
  RunResult done;
  done.name = "lab--default";
  done.input.name = "lab";
  done.input.path = folder.file("a/lab.rawlog").string();
  std::filesystem::create_directories(folder.file("out/runs/lab--default"));
  writeRunResult(done, folder.file("out/runs/lab--default/result.json"));
  EXPECT_THAT(inputNames({"a/lab.rawlog"}), ElementsAre("lab"));
  EXPECT_THAT(inputNames({"b/lab.rawlog"}), ElementsAre("b_lab")) << "another recording";
  EXPECT_THAT(inputNames({"b/lab.rawlog", "a/lab.rawlog"}), ElementsAre("b_lab", "lab"));
  std::filesystem::remove(folder.file("a/lab.rawlog"));
  EXPECT_THAT(inputNames({"b/lab.rawlog"}), ElementsAre("lab")) << "it may have been moved";
  for (const char* name : {"c/hall.rawlog", "d/hall.rawlog"}) touch(name);
  done.input = {};
  done.input.name = "c_hall";
  done.input.path = folder.file("c/hall.rawlog").string();
  std::filesystem::create_directories(folder.file("out/runs/c_hall--default"));
  writeRunResult(done, folder.file("out/runs/c_hall--default/result.json"));
  EXPECT_THAT(inputNames({"c/hall.rawlog", "d/hall.rawlog"}), ElementsAre("c_hall", "d_hall")) << "as when none was done";
}

TEST_F(Plans, RecordingsThatNoFolderTellsApartAreNumbered) {
  touch("a/lab.rawlog");
  touch("a/lab.rawlog.gz");
  const auto names = inputNames({"a/lab.rawlog", "a/lab.rawlog.gz"});
  ASSERT_EQ(names.size(), 2u);
  EXPECT_THAT(names[0], ::testing::EndsWith("a_lab"));
  EXPECT_EQ(names[1], names[0] + "_2");
}

TEST_F(Plans, AFileThatIsThereIsNoPattern) {
  touch("a/lab[1].rawlog");
  touch("a/lab1.rawlog");
  EXPECT_THAT(inputNames({"a/lab[1].rawlog"}), ElementsAre("lab_1_"));
}

TEST_F(Plans, APatternWithoutFilesIsAnError) {
  touch("a/lab.rawlog");
  EXPECT_THAT(messageOf<InputError>([&] { inputNames({"a/*.rawlogs"}); }),
              HasSubstr("*.rawlogs: no such file"));
  EXPECT_THAT(messageOf<InputError>([&] { inputNames({"a"}); }),
              HasSubstr("it is a folder: name the recordings in it"));
}

TEST_F(Plans, SimulatedInputsSayHowTheyAreMade) {
  touch("w.json");
  JobFile jobs;
  InputEntry world, flats;
  world.simulated = SimulatedInputs{folder.file("w.json"), {4}};
  flats.simulated = SimulatedInputs{{}, {9}, 3, true};
  InputEntry furnished;
  furnished.simulated = SimulatedInputs{{}, {9}, 0, false, "/models/chairs"};
  jobs.inputs = {world, flats, furnished};
  const BatchPlan plan = planBatch(jobs, folder.file("out"));
  EXPECT_THAT(plan.inputs[0].simulate, ElementsAre(folder.file("w.json").string(), "--seed", "4"));
  EXPECT_THAT(plan.inputs[1].simulate, ElementsAre("--flat", "9", "--handheld", "--rooms", "3"));
  EXPECT_EQ(plan.inputs[0].input.group, "w");
  EXPECT_EQ(plan.inputs[0].input.seed, 4);
  EXPECT_EQ(plan.inputs[1].input.name, "flat_handheld_3rooms_9");
  EXPECT_THAT(plan.inputs[2].simulate, ElementsAre("--flat", "9", "--meshes", "/models/chairs"));
  EXPECT_EQ(plan.inputs[2].input.name, "flat_chairs_9");
  jobs.inputs.push_back(world);
  EXPECT_THROW(planBatch(jobs, folder.file("out")), ConfigError);
}

TEST_F(Plans, TruthIsFoundBesideTheOnlyRecording) {
  for (const char* name :
       {"a/lab.rawlog", "a/groundtruth_robot.txt", "a/objects.json", "a/boxes.jsonl", "a/map_truth.yaml"})
    touch(name);
  const TruthFiles truth = truthBeside(folder.file("a/lab.rawlog"));
  EXPECT_EQ(truth.size(), 4u);
  EXPECT_EQ(truth.at("trajectory"), folder.file("a/groundtruth_robot.txt"));
  touch("a/other.rawlog");
  touch("a/other.relations");
  touch("a/other.rawlog.GT.txt");
  EXPECT_TRUE(truthBeside(folder.file("a/lab.rawlog")).empty()) << "whose truth it is nobody knows";
  EXPECT_EQ(truthBeside(folder.file("a/other.rawlog")).at("relations"), folder.file("a/other.relations"));
  EXPECT_EQ(truthBeside(folder.file("a/other.rawlog")).at("trajectory"),
            folder.file("a/other.rawlog.GT.txt"));
}

// An import may have mirrored or moved it.
TEST_F(Plans, TruthOfAnImportStandsForThatOfItsFolder) {
  for (const char* name : {"a/lab.rawlog", "a/groundtruth.txt", "a/objects.json", "b/x.rawlog"}) touch(name);
  const auto write = [&](const char* name, TruthOf whose) { std::ofstream(folder.file(name)) << truthComment(whose) << "1 0 0 0 0 0 0 1\n"; };
  write("a/lab.groundtruth.txt", TruthOf::kCamera);
  write("b/x.groundtruth.txt", TruthOf::kRobot);
  const TruthFiles camera = truthBeside(folder.file("a/lab.rawlog"));
  EXPECT_EQ(camera.at("camera_trajectory"), folder.file("a/lab.groundtruth.txt"));
  EXPECT_EQ(camera.size(), 2u) << "and the objects";
  const TruthFiles robot = truthBeside(folder.file("b/x.rawlog"));
  EXPECT_EQ(robot.at("trajectory"), folder.file("b/x.groundtruth.txt"));
  EXPECT_FALSE(robot.contains("camera_trajectory"));
}

TEST_F(Plans, NamedTruthIsFilledIn) {
  for (const char* name : {"a/lab.rawlog", "a/hall.rawlog", "a/lab.tum", "a/hall.tum", "t/objects.json"})
    touch(name);
  JobFile jobs;
  InputEntry entry{.patterns = {folder.file("a/*.rawlog").string()},
                   .truth = {{"trajectory", "{folder}/{name}.tum"}},
                   .search_truth = false,
                   .place = "j:2"};
  jobs.inputs = {entry};
  const BatchPlan plan = planBatch(jobs, folder.file("out"));
  EXPECT_EQ(plan.inputs[0].truth.at("trajectory"), folder.file("a/hall.tum"));
  EXPECT_EQ(plan.inputs[1].truth.at("trajectory"), folder.file("a/lab.tum"));
  jobs.inputs[0].truth = {{"folder", folder.file("t").string()}};
  EXPECT_EQ(planBatch(jobs, folder.file("out")).inputs[0].truth.at("objects"), folder.file("t/objects.json"));
  std::filesystem::remove(folder.file("a/hall.tum"));
  jobs.inputs = {entry};
  EXPECT_THAT(messageOf<InputError>([&] { planBatch(jobs, folder.file("out")); }),
              HasSubstr("j:2: truth.trajectory: "));
}

}  // namespace
}  // namespace roomgraph::test
