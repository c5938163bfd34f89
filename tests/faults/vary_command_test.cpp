// SPDX-License-Identifier: BSD-3-Clause
// The command vary: a mirrored drive gives the mirrored map, truths lie beside the rawlog, errors are one line.
#include <nlohmann/json.hpp>

#include "../regression/program.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::HasSubstr;

const std::string kDrive = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";

nlohmann::json landmarksOf(const std::filesystem::path& run) {
  return nlohmann::json::parse(contentOf(run / "landmarks.json"))["landmarks"];
}

TEST(VaryCommand, TheMirroredDriveGivesTheMirroredMap) {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.file(name).string(); };
  const std::string other = folder.file("m.rawlog").string();
  const auto done = call(folder.path(), {"vary", kDrive, "-o", other, "--mirrored"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("m.rawlog: "));
  ASSERT_EQ(call(folder.path(), {"run", kDrive, "-o", at("a"), "--quiet"}).exit_code, 0);
  ASSERT_EQ(call(folder.path(), {"run", other, "-o", at("b"), "--quiet"}).exit_code, 0);
  const auto landmarks = landmarksOf(folder.file("a")), mirrored = landmarksOf(folder.file("b"));
  ASSERT_GT(landmarks.size(), 0u);
  ASSERT_EQ(mirrored.size(), landmarks.size());
  for (const auto& landmark : landmarks) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& twin : mirrored)
      if (twin["class"] == landmark["class"])
        nearest = std::min(nearest, std::hypot(twin["x"].get<double>() - landmark["x"].get<double>(),
                                               twin["y"].get<double>() + landmark["y"].get<double>()));
    EXPECT_LT(nearest, 0.05) << landmark["class"];
  }
}

TEST(VaryCommand, TruthsLieBesideTheRawlogAndTheWayBackIsAsGood) {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.file(name).string(); };
  ASSERT_EQ(call(folder.path(), {"simulate", ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.json", "-o", at("room")}).exit_code, 0);
  const auto done = call(folder.path(), {"vary", at("room/tiny_room.rawlog"), "-o", at("back.rawlog"), "--backwards",
                                         "--camera-trajectory", at("room/groundtruth.txt"), "--boxes", at("room/boxes.jsonl")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("back.groundtruth.txt\n"));
  EXPECT_TRUE(std::filesystem::exists(folder.file("back.boxes.jsonl")));
  ASSERT_EQ(call(folder.path(), {"run", at("back.rawlog"), "-o", at("b"), "--quiet"}).exit_code, 0);
  const auto ate = call(folder.path(), {"evaluate", "trajectory", at("back.groundtruth.txt"), at("b/trajectory_camera.tum"), "--json", at("ate.json")});
  ASSERT_EQ(ate.exit_code, 0) << ate.err;
  EXPECT_LT(nlohmann::json::parse(contentOf(folder.file("ate.json")))["ate_rmse_m"].get<double>(), 0.02);
}

TEST(VaryCommand, ErrorsAreOneLineWithTheirCode) {
  const TemporaryFolder folder;
  const std::string out = folder.file("y.rawlog").string();
  const auto vary = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "vary");
    return call(folder.path(), words);
  };
  expectOneLine(vary({kDrive, "-o", out}), 2, HasSubstr("no change is asked for"));
  expectOneLine(vary({kDrive, "-o", out, "--field-of-view", "400"}), 2, HasSubstr("--field-of-view"));
  expectOneLine(vary({"nowhere.rawlog", "-o", out, "--backwards"}), 3, HasSubstr("nowhere.rawlog: no such file"));
  expectOneLine(vary({kDrive, "-o", out, "--backwards", "--relations", "no.relations"}), 3,
                HasSubstr("no.relations: cannot be opened: no such file"));
  expectOneLine(vary({kDrive, "-o", out, "--backwards", "--relations", "a/x", "--robot-trajectory", "b/x"}), 2,
                HasSubstr("y.x"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roomgraph
