// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph evaluate` as a user runs it: exit codes, JSON, one clear line on bad input.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::TemporaryFolder;

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

std::string contentOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

Outcome run(const TemporaryFolder& folder, const std::string& arguments) {
  const auto out = folder.path() / "stdout", err = folder.path() / "stderr";
  const std::string command = "cd '" + folder.path().string() + "' && '" ROOMGRAPH_APP "' evaluate " +
                              arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(out), contentOf(err)};
}

TEST(EvaluateCommand, TrajectoryTableAndJson) {
  const TemporaryFolder folder;
  folder.write("truth.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 1 1 0 0 0 0 1\n");
  folder.write("moved.txt", "0 5 5 0\n1 6 5 0\n1 6 5 0\n2 6 6 0\n");
  const auto result = run(folder, "trajectory truth.tum moved.txt --json ate.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("ATE"));
  EXPECT_THAT(result.err, HasSubstr("moved.txt: 1 poses with a repeated stamp dropped"));
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "ate.json"));
  EXPECT_NEAR(figures.at("ate_rmse_m").get<double>(), 0, 1e-9);
  EXPECT_EQ(figures.at("pairs"), 3);
  const std::string truth = contentOf(folder.path() / "truth.tum");
  EXPECT_EQ(run(folder, "trajectory truth.tum moved.txt --json truth.tum").exit_code, 2);
  EXPECT_EQ(contentOf(folder.path() / "truth.tum"), truth) << "an input is no output";
  const auto raw = run(folder, "trajectory truth.tum moved.txt --no-align --json ate.json");
  EXPECT_EQ(raw.exit_code, 0);
  EXPECT_NEAR(nlohmann::json::parse(contentOf(folder.path() / "ate.json")).at("ate_mean_m").get<double>(),
              std::sqrt(50.0), 1e-9);
}

TEST(EvaluateCommand, Relations) {
  const TemporaryFolder folder;
  folder.write("a.relations", "0 1 1 0 0 0 0 0\n1 9 0 0 0 0 0 0\n");
  folder.write("e.tum", "0 0 0 0\n1 1.5 0 0\n");
  const auto result = run(folder, "relations a.relations e.tum --json r.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "r.json"));
  EXPECT_NEAR(figures.at("trans_abs_mean_m").get<double>(), 0.5, 1e-9);
  EXPECT_EQ(figures.at("used"), 1);
  EXPECT_EQ(figures.at("missing"), 1);
}

TEST(EvaluateCommand, ObjectsAlignedByTrajectories) {
  const TemporaryFolder folder;
  folder.write(
      "t.json",
      R"({"objects": [{"id": 1, "class": "sofa", "x": 2, "y": 0, "z": 0, "yaw": 0, "size_wdh": [1, 1, 1]}]})");
  folder.write(
      "m.json",
      R"({"landmarks": [{"id": 1, "class": "sofa", "x": 5, "y": 2, "z": 0, "yaw": 1.5707963267948966, "size_wdh": [1, 1, 1]}]})");
  folder.write("t.tum", "0 0 0 0\n1 1 0 0\n");
  folder.write("m.tum", "0 5 0 1.5707963267948966\n1 5 1 1.5707963267948966\n");
  EXPECT_THAT(run(folder, "objects t.json m.json").out, HasSubstr("missed"));
  const auto result =
      run(folder, "objects t.json m.json --truth-trajectory t.tum --trajectory m.tum --json o.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "o.json"));
  EXPECT_EQ(figures.at("recall"), 1.0);
  EXPECT_NEAR(figures.at("position_error_mean_m").get<double>(), 0, 1e-9);
  EXPECT_NEAR(figures.at("yaw_error_mean_deg").get<double>(), 0, 1e-6);
}

TEST(EvaluateCommand, ClassesAreThoseOfTheRun) {
  const TemporaryFolder folder;
  const std::string bed =
      R"({"id": 1, "class": "bed", "x": 2, "y": 0, "z": 0, "yaw": 0, "size_wdh": [1, 1, 1]})";
  folder.write("t.json", R"({"objects": [)" + bed + "]}");
  folder.write("m.json", R"({"landmarks": [)" + bed + "]}");
  const auto correct = [&](const std::string& more) {
    run(folder, "objects t.json m.json --json o.json" + more);
    return nlohmann::json::parse(folder.read("o.json")).at("correct");
  };
  EXPECT_EQ(correct(""), 0) << "a class that the shipped database does not hold";
  folder.write("objects_here.ini", "[bed]\nshape = cuboid\n");
  EXPECT_EQ(correct(" --database objects_here.ini"), 1);
  folder.write("objects.ini", "[bed]\nshape = cuboid\n");
  EXPECT_EQ(correct(""), 1) << "the database beside the landmarks";
}

TEST(EvaluateCommand, ObjectsWithAssociations) {
  const TemporaryFolder folder;
  folder.write(
      "t.json",
      R"({"objects": [{"id": 1, "class": "sofa", "x": 2, "y": 0, "z": 0, "yaw": 0, "size_wdh": [1, 1, 1]}]})");
  folder.write("m.json", R"({"landmarks": []})");
  std::string boxes, decisions;
  for (int i = 0; i < 4; ++i) {
    const std::string t = std::to_string(i);
    boxes += R"({"frame": )" + t + R"(, "t": )" + t +
             R"(, "objects": [{"id": 1, "class": "sofa", "bbox": [0, 0, 90, 90], "visible": 1, "z_med": 2}]})"
             "\n";
    decisions += R"({"timestamp": )" + t +
                 R"(, "measurements": [{"class": "sofa", "bbox": [0, 0, 90, 90], "landmark": )" +
                 (i < 3 ? "0" : "1") + R"(, "new": )" + (i == 0 || i == 3 ? "true" : "false") +
                 R"(, "posterior": [{"landmark": 0, "p": 0.5}, {"landmark": "new", "p": 0.5}]}]})"
                 "\n";
  }
  folder.write("boxes.jsonl", boxes);
  folder.write("a.jsonl", decisions);
  const auto result =
      run(folder, "objects t.json m.json --truth-boxes boxes.jsonl --associations a.jsonl --json o.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("identity switches 1"));
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "o.json"));
  EXPECT_EQ(figures.at("association_accuracy"), 0.75);
  EXPECT_EQ(figures.at("association_ece"), 0.25);
  EXPECT_EQ(figures.at("identity_switches"), 1);
  EXPECT_EQ(figures.at("associations_needless_new"), 1);
  EXPECT_EQ(figures.at("association_reliability").size(), 10u);
  EXPECT_EQ(figures.at("association_reliability").at(5).at("count"), 4);
  EXPECT_EQ(figures.at("missed"), 0) << "the landmark figures are there, too; 4 frames are too few to count";
  EXPECT_EQ(run(folder, "objects t.json m.json --associations a.jsonl").exit_code, 2);
}

TEST(EvaluateCommand, Detections) {
  const TemporaryFolder folder;
  folder.write(
      "boxes.jsonl",
      R"({"frame": 0, "t": 0, "objects": [{"id": 1, "class": "sofa", "bbox": [0, 0, 90, 90], "visible": 1}]})");
  folder.write("d.jsonl",
               R"({"timestamp": 0.01, "boxes": [{"class": "sofa", "score": 0.4, "bbox": [0, 0, 90, 60]},
    {"class": "door", "score": 0.4, "bbox": [0, 0, 90, 60]}]})");
  EXPECT_EQ(run(folder, "detections boxes.jsonl d.jsonl").exit_code, 3) << "a value over two lines";
  folder.write("d.jsonl",
               R"({"timestamp": 0.01, "boxes": [{"class": "sofa", "score": 0.4, "bbox": [0, 0, 90, 60]}, )"
               R"({"class": "door", "score": 0.4, "bbox": [0, 0, 90, 60]}]})");
  const auto result = run(folder, "detections boxes.jsonl d.jsonl --json d.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "d.json"));
  EXPECT_EQ(figures.at("precision"), 0.5);
  EXPECT_EQ(figures.at("recall"), 1.0);
  EXPECT_EQ(figures.at("ap"), 1.0);
  EXPECT_EQ(figures.at("mean").at("precision"), 0.5);
  EXPECT_TRUE(figures.at("per_class").at("door").at("ap").is_null());
  EXPECT_EQ(figures.at("per_class").at("sofa").at("ap"), 1.0);
  EXPECT_THAT(run(folder, "detections boxes.jsonl d.jsonl --iou 0.7").out, HasSubstr("0.000"));
  folder.write("empty.jsonl", "");
  EXPECT_EQ(run(folder, "detections boxes.jsonl empty.jsonl").exit_code, 1);
  EXPECT_EQ(run(folder, "detections empty.jsonl d.jsonl").exit_code, 3);
}

TEST(EvaluateCommand, MapAlignedByTrajectories) {
  const TemporaryFolder folder;
  const std::string header = "P5\n4 1\n255\n",
                    rest = "resolution: 0.5\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  folder.write("t.pgm", header + "\xfe\xfe\xfe" + std::string(1, '\0'));
  folder.write("t.yaml", "image: t.pgm\norigin: [0.0, 0.0, 0.0]\n" + rest);
  folder.write("m.yaml", "image: t.pgm\norigin: [3.0, 0.0, 0.0]\n" + rest);
  folder.write("t.tum", "0 0 0 0\n1 1 0 0\n");
  folder.write("m.tum", "0 3 0 0\n1 4 0 0\n");
  EXPECT_EQ(run(folder, "map t.yaml m.yaml").exit_code, 1) << "nothing in common";
  const auto result =
      run(folder, "map t.yaml m.yaml --truth-trajectory t.tum --trajectory m.tum --json m.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto figures = nlohmann::json::parse(contentOf(folder.path() / "m.json"));
  EXPECT_EQ(figures.at("precision"), 1.0);
  EXPECT_EQ(figures.at("free_agreement"), 1.0);
  EXPECT_EQ(figures.at("unknown_share"), 0.0);
  EXPECT_NEAR(figures.at("wall_distance_p95_m").get<double>(), 0, 1e-6);
  EXPECT_EQ(figures.at("known_in_both"), 4);
  EXPECT_EQ(run(folder, "map none.yaml m.yaml").exit_code, 3);
  EXPECT_EQ(run(folder, "map t.yaml m.yaml --trajectory m.tum").exit_code, 2);
}

TEST(EvaluateCommand, ExitCodes) {
  const TemporaryFolder folder;
  folder.write("a.tum", "0 0 0 0\n1 1 0 0\n");
  folder.write("late.tum", "100 0 0 0\n");
  folder.write("bad.tum", "0 0 0 0\n1 x 0 0\n");
  const auto bad = run(folder, "trajectory a.tum bad.tum");
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("bad.tum:2: 'x' is not a finite number"));
  EXPECT_EQ(run(folder, "trajectory a.tum none.tum").exit_code, 3);
  EXPECT_EQ(run(folder, "trajectory a.tum late.tum").exit_code, 1);
  EXPECT_EQ(run(folder, "trajectory a.tum").exit_code, 2);
  EXPECT_EQ(run(folder, "trajectory a.tum a.tum --delta 0").exit_code, 2);
  EXPECT_EQ(run(folder, "trajectory a.tum a.tum --json no/such/folder.json").exit_code, 1);
  EXPECT_EQ(run(folder, "").exit_code, 2);
  const auto help = run(folder, "objects --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("--truth-boxes"));
  EXPECT_THAT(help.out, HasSubstr("Example"));
}

}  // namespace
}  // namespace roomgraph
