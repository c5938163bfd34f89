// SPDX-License-Identifier: BSD-3-Clause
// The shipped recordings through the whole program: objects, trajectory and map against the simulator's
// truth.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/estimation/existence.h"
#include "roomgraph/observations/map_file.h"
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
    settings.insert(settings.begin(), {"run", (kSource / "rawlogs" / (name + ".rawlog")).string(), "-o",
                                       out.string(), "--quiet", "--no-snapshot"});
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
  json objects(const fs::path& truth, const std::string& associations = "associations.jsonl") {
    return evaluated({"objects", (truth / "objects.json").string(), (out / "landmarks.json").string(),
                      "--truth-boxes", (truth / "boxes.jsonl").string(), "--associations",
                      (out / associations).string()});
  }
  // Horizontal distances of a class's selected proposals, as they stood at the moment, from its nearest true
  // object.
  std::vector<double> proposalErrors(const fs::path& truth, const std::string& name) const {
    const json objects = json::parse(contentOf(truth / "objects.json")).at("objects");
    std::vector<double> errors;
    for (const auto& line : linesOf(contentOf(out / "associations_live.jsonl"))) {
      const json frame = json::parse(line);
      for (const json& seen : frame.at("measurements")) {
        if (seen.at("class") != name) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (const json& object : objects)
          if (object.at("class") == name)
            nearest = std::min(nearest,
                               std::hypot(object.at("x").get<double>() - seen.at("world")[0].get<double>(),
                                          object.at("y").get<double>() - seen.at("world")[1].get<double>()));
        errors.push_back(nearest);
      }
    }
    return errors;
  }
  /// The probability that the shipped weights make of the evidence beside a landmark.
  static double byEvidence(const json& landmark) {
    const ExistenceOptions weights;
    const std::string shape = landmark.at("shape");
    double log_odds = 0;
    for (const auto& entry : shape == "cylinder" ? weights.cylinder
                             : shape == "cuboid" ? weights.cuboid
                                                 : weights.planar) {
      std::istringstream in(entry);
      std::string name;
      double weight = 0;
      in >> name >> weight;
      log_odds += weight * (name == "bias" ? 1 : landmark.at("evidence").at(name).get<double>());
    }
    return 1 / (1 + std::exp(-log_odds));
  }
  json landmarks() const { return json::parse(contentOf(out / "landmarks.json")).at("landmarks"); }
  static fs::path truthOf(const std::string& name) {
    return kSource / "tests" / "regression" / "truth" / name;
  }

  TemporaryFolder folder;
  fs::path out = folder.file("out");
};

// Recorded boxes of two chairs, a door and a person; depth, scans and wheels.
TEST_F(TruthTest, TinyRoom) {
  run("tiny_room");
  const fs::path truth = truthOf("tiny_room");
  const json way = trajectory(truth / "groundtruth_robot.txt", "trajectory.tum");
  EXPECT_EQ(way.at("coverage"), 1.0);
  EXPECT_LT(way.at("ate_rmse_m"), 0.0045);
  EXPECT_LT(way.at("rpe_rot_rmse_deg"), 0.2);
  const json found = objects(truth);
  EXPECT_EQ(found.at("correct"), 3);
  EXPECT_EQ(found.at("precision"), 1.0);
  EXPECT_EQ(found.at("recall"), 1.0) << "of the objects seen in ten frames or more";
  EXPECT_EQ(found.at("per_class").at("door").at("correct"), 1);
  EXPECT_LT(found.at("position_error_mean_m"), 0.035);
  EXPECT_LT(found.at("position_error_max_m"), 0.06);
  EXPECT_LT(found.at("size_error_mean_m"), 0.051);
  EXPECT_LT(found.at("yaw_error_mean_deg"), 0.58);
  EXPECT_GT(found.at("iou3d_mean"), 0.62);
  EXPECT_GT(found.at("associations_attributed"), 70);
  EXPECT_EQ(found.at("association_accuracy"), 1.0);
  EXPECT_EQ(found.at("identity_switches"), 0);
  for (const json& landmark : landmarks()) {
    EXPECT_NEAR(landmark.at("z"), 0, 0.02) << "they stand on the floor";
    EXPECT_NE(landmark.at("class"), "person");
    EXPECT_GT(landmark.at("existence"), 0.85);
    EXPECT_NEAR(landmark.at("existence"), byEvidence(landmark), 1e-6)
        << "of all evidence, not of so many boxes alone";
  }
  const json map = evaluated({"map", (truth / "map_truth.yaml").string(), (out / "map.yaml").string()});
  EXPECT_GT(map.at("f1"), 0.99) << "of occupied cells, to one cell";
  EXPECT_GT(map.at("free_agreement"), 0.976);
  EXPECT_LT(map.at("unknown_share"), 0.11);
  EXPECT_LT(map.at("wall_distance_mean_m"), 0.04);
}

// Recorded boxes of a sofa and a chair: a shape with a front, ends and a usual size that this one has not.
TEST_F(TruthTest, TinyLounge) {
  run("tiny_lounge");
  const fs::path truth = truthOf("tiny_lounge");
  EXPECT_LT(trajectory(truth / "groundtruth_robot.txt", "trajectory.tum").at("ate_rmse_m"), 0.0056);
  const json found = objects(truth);
  EXPECT_EQ(found.at("correct"), 2);
  EXPECT_EQ(found.at("precision"), 1.0) << "the armchair is none of them";
  EXPECT_EQ(found.at("recall"), 1.0);
  const json& sofa = found.at("per_class").at("sofa");
  EXPECT_EQ(sofa.at("correct"), 1);
  EXPECT_LT(sofa.at("position_error_mean_m"), 0.087);
  EXPECT_LT(sofa.at("yaw_error_mean_deg"), 0.4) << "and its front is not its back";
  EXPECT_LT(sofa.at("size_error_mean_m"), 0.075);
  EXPECT_GT(sofa.at("iou3d_mean"), 0.83);
  EXPECT_EQ(found.at("associations_attributed"), 49);
  EXPECT_EQ(found.at("association_accuracy"), 1.0);
  for (const json& landmark : landmarks()) EXPECT_GT(landmark.at("existence"), 0.95);
}

// What each stage hands on, so that none hides behind those after it.
TEST_F(TruthTest, TinyRoomStageByStage) {
  run("tiny_room");
  const fs::path truth = truthOf("tiny_room");
  const std::vector<double> chairs = proposalErrors(truth, "swivel_chair"),
                            doors = proposalErrors(truth, "door");
  EXPECT_GT(chairs.size(), 45U);
  EXPECT_GT(doors.size(), 25U);
  EXPECT_LT(quantile(chairs, 0.5), 0.054);
  EXPECT_LT(quantile(chairs, 0.9), 0.13);
  EXPECT_LT(quantile(doors, 0.5), 0.082);
  EXPECT_GT(objects(truth, "associations_live.jsonl").at("association_accuracy"), 0.97);
  EXPECT_LT(trajectory(truth / "groundtruth_robot.txt", "live.tum").at("ate_rmse_m"), 0.018);
  const json counts = json::parse(contentOf(out / "summary.json")).at("counts");
  EXPECT_GT(counts.at("returns_on_people"), 300);
  EXPECT_EQ(counts.at("frames_lost"), 0);
  EXPECT_EQ(counts.at("scans_unmatched"), 0);
}

double yawOf(const Eigen::Quaterniond& q) {
  return std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
}

// Places, yaws and sizes of the map are those of the graph, to the last digit: the optimum, not the filter's.
TEST_F(TruthTest, TinyRoomIsTheOptimumOfItsGraph) {
  run("tiny_room");
  std::map<std::string, Eigen::Vector2d> places;  // of vertices
  std::map<std::string, double> yaws;
  std::map<int, std::string> vertices;  // of landmarks
  std::map<int, Eigen::Vector3d> sizes;
  for (const auto& line : linesOf(contentOf(out / "graph.g2o"))) {
    std::istringstream words(line);
    std::string tag, vertex, shape;
    int id = 0;
    if (words >> tag >> vertex && tag == "VERTEX_SE3:QUAT") {
      double z = 0;
      Eigen::Quaterniond turn;
      words >> places[vertex].x() >> places[vertex].y() >> z >> turn.x() >> turn.y() >> turn.z() >> turn.w();
      yaws[vertex] = yawOf(turn);
    } else if (vertex == "LANDMARK" && words >> vertex >> id >> shape) {
      vertices[id] = vertex;
      words >> sizes[id].x() >> sizes[id].y() >> sizes[id].z();
    }
  }
  const json all = landmarks();
  ASSERT_EQ(all.size(), 3U);
  for (const json& landmark : all) {
    const int id = landmark.at("id");
    const json size = landmark.at("size_wdh");
    EXPECT_LT((Eigen::Vector2d(landmark.at("x"), landmark.at("y")) - places.at(vertices.at(id))).norm(), 1e-9)
        << id;
    EXPECT_LT((Eigen::Vector3d(size[0], size[1], size[2]) - sizes.at(id)).norm(), 1e-9) << id;
    EXPECT_NEAR(std::remainder(landmark.at("yaw").get<double>() - yaws.at(vertices.at(id)), 2 * M_PI), 0, 1e-7) << id;
  }
}

TEST_F(TruthTest, TinyRoomIsTheSameInAllFiles) {
  run("tiny_room");
  const CSemanticMap map = loadMap(out / "map.rgmap");
  const json all = landmarks();
  ASSERT_EQ(all.size(), map.landmarks.size());
  for (const json& in_text : all) {
    const auto same = [&](const Landmark& landmark) { return landmark.id.value == in_text.at("id"); };
    const auto landmark = std::find_if(map.landmarks.begin(), map.landmarks.end(), same);
    ASSERT_NE(landmark, map.landmarks.end());
    EXPECT_NEAR(landmark->position.x(), in_text.at("x"), 1e-9);
    EXPECT_NEAR(landmark->position.y(), in_text.at("y"), 1e-9);
    EXPECT_NEAR(landmark->position.z(), in_text.at("z"), 1e-9);
    EXPECT_NEAR(landmark->yaw, in_text.at("yaw"), 1e-9);
    EXPECT_NEAR(landmark->shape.width, in_text.at("size_wdh")[0], 1e-9);
    EXPECT_NEAR(landmark->shape.depth, in_text.at("size_wdh")[1], 1e-9);
    EXPECT_NEAR(landmark->shape.height, in_text.at("size_wdh")[2], 1e-9);
    EXPECT_NEAR(landmark->existence, in_text.at("existence"), 1e-9);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        EXPECT_NEAR(landmark->covariance(row, column), in_text.at("covariance")[row][column], 1e-9) << row << ", " << column;
  }
}

// Each source of movement without the others, which would make up for it.
TEST_F(TruthTest, TinyRoomByOneSensor) {
  struct Arm {
    std::string off, also_off;
    double ate_m;
  };
  for (const Arm& arm : {Arm{"odometry", "lidar", 0.006}, Arm{"odometry", "tracking", 0.011},
                         Arm{"tracking", "lidar", 0.087}}) {
    run("tiny_room", {"--set", arm.off + ".enabled=false", "--set", arm.also_off + ".enabled=false"});
    const json way = trajectory(truthOf("tiny_room") / "groundtruth_robot.txt", "trajectory.tum");
    EXPECT_LT(way.at("ate_rmse_m"), arm.ate_m) << "without " << arm.off << " and " << arm.also_off;
  }
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
        record["boxes"].push_back(
            {{"class", object.at("class")}, {"score", 0.9}, {"bbox", object.at("bbox")}});
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
