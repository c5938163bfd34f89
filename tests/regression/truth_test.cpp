// SPDX-License-Identifier: BSD-3-Clause
// The shipped recordings through the whole program: objects, trajectory and map against the simulator's truth.
#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kSource = ROOMGRAPH_SOURCE_DIR;

// Limits are about 1.4 times what the program reaches: half its accuracy does not pass.
class TruthTest : public ::testing::Test {
 protected:
  void run(const std::string& name, std::vector<std::string> settings = {}) {
    settings.insert(settings.begin(), {"run", (kSource / "rawlogs" / (name + ".rawlog")).string(), "-o", out.string(),
                                       "--quiet", "--no-snapshot"});
    const CallResult result = call(folder.path(), settings);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  json evaluated(std::vector<std::string> arguments) {
    const fs::path figures = folder.file("figures.json");
    arguments.insert(arguments.begin(), "evaluate");
    arguments.insert(arguments.end(), {"--json", figures.string()});
    const CallResult result = call(folder.path(), arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(contentOf(figures));
  }
  json trajectory(const fs::path& truth, const std::string& estimate) {
    return evaluated({"trajectory", truth.string(), (out / estimate).string()});
  }
  // Both worlds begin at the first pose, so nothing is aligned.
  json objects(const fs::path& truth) {
    return evaluated({"objects", (truth / "objects.json").string(), (out / "landmarks.json").string(), "--truth-boxes",
                      (truth / "boxes.jsonl").string(), "--associations", (out / "associations.jsonl").string()});
  }
  json landmarks() const { return json::parse(contentOf(out / "landmarks.json")).at("landmarks"); }
  static fs::path truthOf(const std::string& name) { return kSource / "tests" / "regression" / "truth" / name; }

  TemporaryFolder folder;
  fs::path out = folder.file("out");
};

// Recorded boxes of two chairs, a door and a person; depth, scans and wheels.
TEST_F(TruthTest, TinyRoom) {
  run("tiny_room");
  const fs::path truth = truthOf("tiny_room");
  const json way = trajectory(truth / "groundtruth_robot.txt", "trajectory.tum");
  EXPECT_EQ(way.at("coverage"), 1.0);
  EXPECT_LT(way.at("ate_rmse_m"), 0.009);
  EXPECT_LT(way.at("rpe_rot_rmse_deg"), 0.36);
  const json found = objects(truth);
  EXPECT_EQ(found.at("correct"), 3);
  EXPECT_EQ(found.at("precision"), 1.0);
  EXPECT_EQ(found.at("recall"), 1.0) << "of the objects seen in ten frames or more";
  EXPECT_EQ(found.at("per_class").at("door").at("correct"), 1);
  EXPECT_LT(found.at("position_error_mean_m"), 0.051);
  EXPECT_LT(found.at("position_error_max_m"), 0.06);
  EXPECT_LT(found.at("size_error_mean_m"), 0.051);
  EXPECT_LT(found.at("yaw_error_mean_deg"), 1.0);
  EXPECT_GT(found.at("iou3d_mean"), 0.62);
  EXPECT_GT(found.at("associations_attributed"), 70);
  EXPECT_EQ(found.at("association_accuracy"), 1.0);
  EXPECT_EQ(found.at("identity_switches"), 0);
  for (const json& landmark : landmarks()) {
    EXPECT_NEAR(landmark.at("z"), 0, 0.02) << "they stand on the floor";
    EXPECT_NE(landmark.at("class"), "person");
  }
  const json map = evaluated({"map", (truth / "map_truth.yaml").string(), (out / "map.yaml").string()});
  EXPECT_GT(map.at("f1"), 0.99) << "of occupied cells, to one cell";
  EXPECT_GT(map.at("free_agreement"), 0.976);
  EXPECT_LT(map.at("unknown_share"), 0.11);
  EXPECT_LT(map.at("wall_distance_mean_m"), 0.04);
}

// Only images and depth; the true boxes, which the recording does not hold, stand for a detector's.
TEST_F(TruthTest, TinyHandheld) {
  const fs::path truth = truthOf("tiny_handheld");
  std::string boxes;
  for (const auto& line : linesOf(contentOf(truth / "boxes.jsonl"))) {
    const json frame = json::parse(line);
    json record{{"timestamp", frame.at("t")}, {"boxes", json::array()}};
    for (const json& object : frame.at("objects"))
      if (object.at("class") != "other" && object.at("visible") > 0.4)
        record["boxes"].push_back({{"class", object.at("class")}, {"score", 0.9}, {"bbox", object.at("bbox")}});
    boxes += record.dump() + "\n";
  }
  run("tiny_handheld", {"--set", "detection.file=" + folder.write("boxes.jsonl", boxes).string()});
  const json way = trajectory(truth / "groundtruth.txt", "trajectory_camera.tum");
  EXPECT_EQ(way.at("coverage"), 1.0);
  EXPECT_LT(way.at("ate_rmse_m"), 0.054);
  const json found = objects(truth);
  EXPECT_EQ(found.at("correct"), 1) << "the chair";
  EXPECT_EQ(found.at("precision"), 1.0);
  EXPECT_EQ(found.at("recall"), 1.0);
  EXPECT_LT(found.at("position_error_max_m"), 0.066);
  EXPECT_LT(found.at("size_error_mean_m"), 0.051);
  EXPECT_GT(found.at("iou3d_mean"), 0.62);
  EXPECT_GT(found.at("associations_attributed"), 50);
  EXPECT_EQ(found.at("association_accuracy"), 1.0);
  for (const json& landmark : landmarks()) EXPECT_NEAR(landmark.at("z"), 0, 0.03) << "the world was levelled";
}

}  // namespace
}  // namespace roomgraph::test
