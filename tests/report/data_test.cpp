// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the page against the files of a run, worked out anew.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "made_up_run.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;

class ReportData : public ::testing::Test {
 protected:
  ReportData() { writeRun(folder); }
  const TemporaryFolder folder;
};

TEST_F(ReportData, FiguresAreThoseOfTheSummary) {
  const json run = runOf(folder), summary = json::parse(folder.read("summary.json"));
  EXPECT_EQ(run["counts"], summary["counts"]);
  EXPECT_EQ(run["records_skipped"], summary["records_skipped"]);
  EXPECT_EQ(run["reasons"]["too dark"], 7);
  EXPECT_EQ(run["warnings"], (json{"cut off", "two lidars"}));
  EXPECT_EQ(run["peak_memory_mb"], 123.4);
  EXPECT_EQ(run["wall_s"], 12.3);
  EXPECT_EQ(run["least_gap_s"], 1);
  EXPECT_EQ(run["version"], "1.2 (abc)");
  EXPECT_EQ(run["command"], "roomgraph run x y");
  EXPECT_EQ(run["recording"], "made_up.rawlog");
  EXPECT_TRUE(run["missing"].empty()) << run["missing"];
}

TEST_F(ReportData, TheWayIsThatOfTheCircle) {
  const json run = runOf(folder);
  EXPECT_NEAR(run["duration"], 19.9, 1e-9);
  EXPECT_EQ(run["poses"], 200);
  EXPECT_NEAR(run["length_m"], 2 * 19.9 / 8, 0.002) << "radius times angle";
  EXPECT_EQ(run["start"], kStart);
  const json& path = run["path"];
  ASSERT_EQ(path.size() % 4, 0u);
  EXPECT_LT(path.size() / 4, 40u) << "a circle needs few corners";
  for (std::size_t i = 0; i < path.size(); i += 4) {
    const auto [x, y, yaw] = poseAtTime(path[i]);
    EXPECT_NEAR(path[i + 1], x, 1e-3);
    EXPECT_NEAR(path[i + 2], y, 1e-3);
    EXPECT_NEAR(path[i + 3], yaw, 1e-3);
  }
}

TEST_F(ReportData, HindsightIsTheDistanceOfLiveAndFinal) {
  const json series = runOf(folder)["hindsight_m"];
  ASSERT_EQ(series["high"].size(), series["low"].size());
  const auto& high = series["high"];
  EXPECT_NEAR(high.back(), 0.001 * 19.9, 1e-4);
  EXPECT_NEAR(series["low"].front(), 0, 1e-4);
  ASSERT_EQ(high.size(), 100u) << "two poses in each part";
  for (std::size_t i = 0; i < high.size(); ++i)
    EXPECT_NEAR(high[i].get<double>() - series["low"][i].get<double>(), 1e-4, 1.1e-4)
        << "0.001 m/s over 0.1 s";
}

TEST_F(ReportData, ObjectsAreThoseOfTheMapAndTheCandidates) {
  const json objects = runOf(folder)["objects"];
  ASSERT_EQ(objects.size(), 5u);
  for (const json& object : objects) {
    const json expected = madeUpObject(object["id"]);
    EXPECT_EQ(object["in_map"], object["id"] < 3);
    EXPECT_EQ(object["class"], expected["class"]);
    EXPECT_EQ(object["place"], (json{expected["x"], expected["y"], expected["z"]}));
    EXPECT_EQ(object["size"], expected["size_wdh"]);
    ASSERT_EQ(object["footprint"].size(), 4u);
    for (int corner = 0; corner < 4; ++corner)
      for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(object["footprint"][corner][i], expected["footprint"][corner][i], 1e-9);
    EXPECT_EQ(object["covariance"], (json{.04, .01, .02}));
    EXPECT_NEAR(object["z_sigma_m"], 0.01, 1e-9);
    EXPECT_NEAR(object["yaw_sigma_rad"], 0.03, 1e-9);
    EXPECT_EQ(object["posterior"], expected["class_posterior"]);
    EXPECT_EQ(object["evidence"], expected["evidence"]);
    EXPECT_EQ(object["yaw"].is_null(), !expected["has_yaw"].get<bool>());
    EXPECT_EQ(object["observations"], expected["observations"]);
  }
}

// Counted from the lines of the file, without the code that the report uses.
TEST_F(ReportData, SightingsAreCountedAgain) {
  struct Count {
    int all = 0, made_new = 0, doubtful = 0;
    double sum = 0, first = 1e9, last = 0, rival = 0;
  };
  std::map<int, Count> expected;
  std::istringstream lines(folder.read("associations.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const json frame = json::parse(line);
    for (const json& m : frame["measurements"]) {
      Count& count = expected[m["landmark"]];
      const double p = m["posterior"][0]["p"], t = frame["timestamp"].get<double>() - kStart;
      ++count.all;
      count.made_new += m["new"] == true;
      count.doubtful += p < 0.9;
      count.sum += p;
      count.rival += 1 - p;
      count.first = std::min(count.first, t);
      count.last = std::max(count.last, t);
    }
  }
  const json run = runOf(folder);
  for (const json& object : run["objects"]) {
    const int id = object["id"];
    if (!expected.contains(id)) {
      EXPECT_TRUE(object["sightings"].is_null());
      continue;
    }
    const Count& count = expected[id];
    const json& seen = object["sightings"];
    EXPECT_EQ(seen["count"], count.all);
    EXPECT_EQ(seen["made_new"], count.made_new);
    EXPECT_EQ(seen["doubtful"], count.doubtful);
    EXPECT_NEAR(seen["mean_probability"], count.sum / count.all, 1e-4);
    EXPECT_EQ(seen["least_probability"], 0.6);
    EXPECT_NEAR(seen["first"], count.first, 0.006);
    EXPECT_NEAR(seen["last"], count.last, 0.006);
    ASSERT_EQ(seen["rivals"].size(), 1u);
    EXPECT_EQ(seen["rivals"][0]["id"], (id + 1) % 3);
    EXPECT_NEAR(seen["rivals"][0]["sum"], count.rival, 1e-3);
    int in_histogram = 0;
    for (const json& n : seen["over_time"]) in_histogram += n.get<int>();
    EXPECT_EQ(in_histogram, count.all);
  }
}

TEST_F(ReportData, StagesAndWorkPerRecord) {
  const json run = runOf(folder);
  ASSERT_EQ(run["stages"].size(), 2u);
  for (const json& stage : run["stages"]) {
    EXPECT_EQ(stage["calls"], 200);
    EXPECT_NEAR(stage["total_ms"], 500, 1e-9);
    EXPECT_NEAR(stage["cpu_ms"], 1000, 1e-6) << stage["name"];
  }
  for (const json& value : run["record_ms"]["high"]) EXPECT_EQ(value, 5) << "two stages of 2.5 ms";
}

TEST_F(ReportData, MemoryOverTimeIsThatOfTheCalls) {
  const json series = runOf(folder)["memory_mb"];
  ASSERT_EQ(series["high"].size(), 100u) << "two records in each part";
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(series["low"][i], 100 + 2 * i);
    EXPECT_EQ(series["high"][i], 101 + 2 * i);
  }
}

TEST_F(ReportData, TimingsOfEarlierVersionsSayNothingOfMemory) {
  folder.write("timings.csv", "timestamp,stage,ms,cpu_ms\n" + std::to_string(kStart + 1) + ",matching,2,3\n");
  const json run = runOf(folder);
  EXPECT_TRUE(run["missing"].empty()) << run["missing"];
  for (const json& value : run["memory_mb"]["high"]) EXPECT_TRUE(value.is_null());
  EXPECT_EQ(run["stages"][0]["cpu_ms"].get<double>() + run["stages"][1]["cpu_ms"].get<double>(), 3);
}

TEST_F(ReportData, SpansWithoutASensorCountFromTheFirstPose) {
  const json lost = runOf(folder)["lost"];
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_EQ(lost[0],
            (json{{"sensor", "camera"}, {"from", 4}, {"to", 6.5}, {"records", 25}, {"why", "too dark"}}));
  EXPECT_EQ(lost[1]["from"], 0);
  std::filesystem::remove(folder.file("lost.jsonl"));
  const json run = runOf(folder);
  EXPECT_TRUE(run["lost"].is_null());
  EXPECT_TRUE(run["missing"].empty()) << "earlier versions write none";
}

TEST_F(ReportData, FindingsAboutTheRecordingAreThoseOfTheSummary) {
  json summary = json::parse(folder.read("summary.json"));
  EXPECT_EQ(runOf(folder)["findings"], summary["findings"]);
  summary["findings"] = nullptr;
  folder.write("summary.json", summary.dump());
  EXPECT_TRUE(runOf(folder)["findings"].is_null()) << "not examined";
  summary["findings"] = json::array();
  folder.write("summary.json", summary.dump());
  EXPECT_EQ(runOf(folder)["findings"], json::array()) << "nothing is wrong with it";
}

TEST_F(ReportData, LoopClosuresTieKeyPosesThatDoNotFollowEachOther) {
  const json closures = runOf(folder)["closures"];
  ASSERT_EQ(closures.size(), 1u);
  EXPECT_THAT(closures[0]["ids"].get<std::vector<int>>(), ElementsAre(3, 0));
  EXPECT_THAT(closures[0]["t"].get<std::vector<double>>(), ElementsAre(15, 0));
  EXPECT_THAT(closures[0]["a"].get<std::vector<double>>(), ElementsAre(3, 6));
  EXPECT_THAT(closures[0]["b"].get<std::vector<double>>(), ElementsAre(0, 0));
  EXPECT_EQ(closures[0]["kind"], "lidar");
  EXPECT_TRUE(closures[0]["off_m"].is_null()) << "an edge without its information";
}

TEST_F(ReportData, ConfigMarksWhatDiffersFromEveryShippedText) {
  const json config = runOf(folder)["config"];
  ASSERT_EQ(config.size(), 3u);
  EXPECT_FALSE(config[0].contains("shipped")) << "5e-04 is 0.0005";
  EXPECT_EQ(config[1]["shipped"], "1");
  EXPECT_FALSE(config[2].contains("shipped"));
}

TEST_F(ReportData, ColoursAreThoseOfTheDatabase) {
  EXPECT_EQ(runOf(folder)["colours"], (json{{"sofa", "#3f7fd0"}})) << "red is no #rrggbb";
}

std::vector<unsigned char> fromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0, held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (held -= 8) & 255));
  }
  return bytes;
}

TEST_F(ReportData, TheGridIsAPictureWithTheFirstRowOnTop) {
  const json grid = runOf(folder)["grid"];
  EXPECT_EQ(grid["cell_m"], 0.5);
  EXPECT_EQ(grid["x_min"], -1);
  EXPECT_EQ(grid["y_min"], -2);
  const cv::Mat image = cv::imdecode(fromBase64(grid["png"]), cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(image.size(), cv::Size(4, 3));
  for (int u = 0; u < 4; ++u) {
    EXPECT_EQ(image.at<unsigned char>(0, u), 0);
    EXPECT_EQ(image.at<unsigned char>(1, u), 255);
    EXPECT_EQ(image.at<unsigned char>(2, u), 128);
  }
}

TEST_F(ReportData, ViewsAreShownWhereTheyAre) {
  const json before = runOf(folder)["objects"];
  folder.write("views.jsonl", json{{"id", before[1]["id"]}, {"jpeg", "cGljdHVyZQ=="}}.dump() + "\n" +
                                  json{{"id", 4711}, {"jpeg", "AAAA"}}.dump() + "\n");
  const json objects = runOf(folder)["objects"];
  EXPECT_FALSE(objects[0].contains("view"));
  ASSERT_TRUE(objects[1].contains("view"));
  EXPECT_EQ(objects[1]["view"], "cGljdHVyZQ==");
}

// The truth is the final path, turned by 90 degrees and moved: aligned, only the live errors are left.
TEST_F(ReportData, ErrorsAreThoseAfterAlignment) {
  std::ofstream truth(folder.file("truth.txt"));
  truth << std::fixed << std::setprecision(7);
  for (int i = 0; i < 200; ++i) {
    const auto [x, y, yaw] = poseAtTime(i / 10.);
    const double half = (yaw + std::numbers::pi / 2) / 2;
    truth << kStart + i / 10. << ' ' << 7 - y << ' ' << x - 3 << " 0 0 0 " << std::sin(half) << ' '
          << std::cos(half) << '\n';
  }
  truth.close();
  const json run = dataOf(reportOf(folder, folder.file("truth.txt"))).at("runs").at(0);
  EXPECT_NEAR(run["final_errors"]["ate_m"]["rmse"], 0, 1e-5);
  EXPECT_EQ(run["final_errors"]["pairs"], 200);
  EXPECT_GT(run["live_errors"]["ate_m"]["rmse"], 0.002);
  EXPECT_LT(run["live_errors"]["ate_m"]["max"], 0.02) << "aligned: less than what it is off at the end";
  EXPECT_NEAR(run["truth_path"][1], 0, 2e-3) << "the truth lies on the run's own map";
  EXPECT_NEAR(run["truth_path"][2], 0, 2e-3);
  double largest = 0;
  for (const json& value : run["live_errors"]["position_m"]["high"])
    if (!value.is_null()) largest = std::max(largest, value.get<double>());
  EXPECT_NEAR(largest, run["live_errors"]["ate_m"]["max"], 1e-4);
}

// Truth of a handheld recording is that of the camera: here .3 m ahead of the robot, looking ahead, in its optical frame.
TEST_F(ReportData, ATruthOfTheCameraIsComparedWithTheCamera) {
  const Pose3 robot_from_camera = poseFromYpr(0.3, 0, 1, 0, 0, 0) * Pose3(Eigen::Isometry3d(bodyFromOptical()));
  for (const char* name : {"truth.txt", "trajectory_camera.tum"}) {
    std::ofstream out(folder.file(name));
    out << std::fixed << std::setprecision(7);
    for (int i = 0; i < 200; ++i) {
      const auto [x, y, yaw] = poseAtTime(i / 10.);
      const Pose3 pose = poseFromYpr(x, y, 0, yaw, 0, 0) * robot_from_camera;
      const Eigen::Quaterniond q(pose.linear());
      out << kStart + i / 10. << ' ' << pose.translation().transpose() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
    }
  }
  const json run = dataOf(reportOf(folder, folder.file("truth.txt"))).at("runs").at(0);
  EXPECT_TRUE(run["truth_is_of_camera"]);
  EXPECT_NEAR(run["final_errors"]["ate_m"]["rmse"], 0, 1e-5);
  EXPECT_LT(run["final_errors"]["rpe_rot_deg"]["rmse"], 0.01);
  EXPECT_GT(run["live_errors"]["ate_m"]["rmse"], 0.002);
  EXPECT_FALSE(dataOf(reportOf(folder, folder.file("trajectory.tum"))).at("runs").at(0)["truth_is_of_camera"]);
}

TEST_F(ReportData, EvaluationsBesideTheRunAreShown) {
  folder.write("ev.json", R"({"precision": 0.5, "per_class": {}, "association_reliability": [
    {"from": 0, "to": 0.1, "count": 0, "mean_probability": null, "correct_share": null},
    {"from": 0.9, "to": 1, "count": 8, "mean_probability": 0.97, "correct_share": 0.75}]})");
  folder.write("other.json", R"({"precise": 1})");
  folder.write("relations.json", R"({"trans_abs_rmse_m": 0.02, "relations_used": 8})");
  const json evaluations = runOf(folder)["evaluations"];
  ASSERT_EQ(evaluations.size(), 2u);
  EXPECT_EQ(evaluations[1]["file"], "relations.json");
  EXPECT_EQ(evaluations[0]["file"], "ev.json");
  EXPECT_EQ(evaluations[0]["figures"], (json{{"precision", 0.5}}));
  ASSERT_EQ(evaluations[0]["reliability"].size(), 1u);
  EXPECT_EQ(evaluations[0]["reliability"][0]["correct"], 0.75);
}

TEST_F(ReportData, RunsStandInTheOrderInWhichTheyAreNamed) {
  const json runs =
      dataOf(makeReport({{{folder.path(), "first"}, {folder.path(), "second"}}, {}, {}}))["runs"];
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0]["name"], "first");
  EXPECT_EQ(runs[1]["name"], "second");
}

}  // namespace
}  // namespace roomgraph::test
