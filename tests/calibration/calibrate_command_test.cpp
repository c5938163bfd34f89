// SPDX-License-Identifier: BSD-3-Clause
// The command calibrate on a small rendered recording whose calibration is deliberately wrong.
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "../regression/program.h"
#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/geometry/degree.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A room with pictures on its walls for the camera, and two rounds through it with a turn at every corner.
const char* const kWorld = R"({
  "name": "room",
  "rooms": [{"name": "room", "corner_m": [0, 0], "size_m": [5, 4], "wall": {"pattern": "plaster", "color": "#d8d2c4"},
    "posters": [{"side": "north", "at_m": 3.4, "z_m": 1.0, "variant": 41}, {"side": "east", "at_m": 1.4, "z_m": 1.0, "variant": 42},
                {"side": "south", "at_m": 1.9, "z_m": 0.9, "variant": 43}, {"side": "west", "at_m": 2.2, "z_m": 1.1, "variant": 44}]}],
  "furniture": [{"model": "plant", "at_m": [4.6, 0.4]}, {"model": "sofa", "at_m": [2.5, 3.5], "yaw_deg": -90}],
  "robot": {"path_m": [[1.2, 1.2], [3.4, 1.1], [3.7, 2.2], [2.2, 2.5], [1.3, 2.3], [1.2, 1.2], [2.8, 1.6], [3.6, 1.0], [1.5, 1.3]],
            "max_speed_m_s": 0.4},
  "sensors": {"camera": {"preset": "kinect", "rate_hz": 6, "width_px": 320, "height_px": 240, "at_m": [0.06, 0.01, 0.7]},
              "lidar": {"preset": "rplidar", "rate_hz": 10, "at_m": [0.05, 0, 0.3], "sigma_m": 0.006, "sigma_relative": 0.003},
              "odometry": {"preset": "kobuki", "rate_hz": 20, "slips": 0, "scale_error": 0.03, "turn_error": -0.02,
                           "drift_deg_m": 0.4, "sigma_length": 0.01, "sigma_turn": 0.01}}
})";

// Off by 5 cm and 5 degrees and by 30 ms.
const char* const kWrong =
    "[sensor KINECT]\npose = 0.09,-0.03,0.7,-4,15,2\ntime_offset_s = 0.03\n"
    "[sensor LIDAR]\npose = 0.02,0.04,0.3,5,0,0\n[wheels]\ntime_offset_s = -0.03\n";

class CalibrateCommand : public ::testing::Test {
 protected:
  CallResult calibrate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "calibrate");
    return call(folder.path(), arguments);
  }
  std::string at(const std::string& name) { return folder.file(name).string(); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder.file(name)) << text;
    return at(name);
  }
  TemporaryFolder folder;
};

TEST_F(CalibrateCommand, FindsWhereSensorsSitAndWritesIt) {
  const auto simulated =
      call(folder.path(), {"simulate", write("world.json", kWorld), "-o", at("true"), "--quiet"});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const std::string wrong = at("wrong.rawlog");
  const auto applied = calibrate(
      {at("true/room.rawlog"), "--apply", write("wrong.ini", kWrong), "--rawlog", wrong, "--jpeg", "95"});
  ASSERT_EQ(applied.exit_code, 0) << applied.err;
  EXPECT_THAT(call(folder.path(), {"info", wrong}).out, HasSubstr("roomgraph calibrate"));

  const auto done = calibrate({wrong, "-o", at("found.ini"), "--json", at("found.json"), "--rawlog",
                               at("mended.rawlog"), "--jpeg", "95"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("camera yaw"), HasSubstr("fixed by this motion"),
                              HasSubstr("wheel movements")));
  const auto found = nlohmann::json::parse(contentOf(folder.file("found.json")));
  const std::map<std::string, double> truth{{"lidar x", 0.05},
                                            {"lidar y", 0},
                                            {"lidar yaw", 0},
                                            {"camera x", 0.06},
                                            {"camera y", 0.01},
                                            {"camera z", 0.7},
                                            {"camera yaw", 0},
                                            {"camera pitch", 12 * kDegree},
                                            {"camera roll", 0},
                                            {"depth bias", 0},
                                            {"depth scale", 1},
                                            {"camera time offset", -0.03},
                                            {"wheel time offset", 0.03},
                                            {"wheel scale", 1 / 1.03},
                                            {"wheel turn scale", 1 / 0.98}};
  std::map<std::string, double> limits{{"m", 0.012}, {"rad", 0.5 * kDegree}, {"s", 0.005}, {"", 0.012}};
  for (const auto& parameter : found.at("parameters")) {
    const auto expected = truth.find(parameter.at("name"));
    if (expected == truth.end()) continue;
    const double off = parameter.at("after").get<double>() - expected->second;
    EXPECT_LT(std::abs(off), limits.at(parameter.at("unit"))) << parameter;
    EXPECT_LT(std::abs(off), 6 * parameter.at("sigma").get<double>()) << parameter;
  }

  const Calibration file = readCalibration(folder.file("found.ini"));
  EXPECT_LT((file.poses.at("LIDAR").translation() - Eigen::Vector3d(0.05, 0, 0.3)).norm(), 0.012);
  EXPECT_NEAR(file.corrections.time_offsets_s.at("KINECT"), -0.03, 0.005);
  EXPECT_THAT(contentOf(folder.file("found.ini")), AllOf(HasSubstr("# lidar x +-"), HasSubstr("# Frame: ")));
  EXPECT_THAT(call(folder.path(), {"info", at("mended.rawlog")}).out, Not(HasSubstr("roomgraph calibrate")));
  const auto run =
      call(folder.path(), {"run", wrong, "-o", at("out"), "--calibration", at("found.ini"), "--quiet",
                           "--no-report", "--no-snapshot", "--set", "detection.enabled=false"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

// Half a minute before a board on a wall. Depth is measured nowhere: no floor, no wall and no visual odometry help.
TEST_F(CalibrateCommand, UsesABoard) {
  const char* const world = R"({
    "name": "board",
    "rooms": [{"name": "room", "corner_m": [0, 0], "size_m": [5, 4], "wall": {"pattern": "plain", "color": "#d8d2c4"},
      "posters": [{"side": "east", "at_m": 2, "z_m": 0.8, "width_m": 0.96, "height_m": 0.72, "pattern": "chessboard"}]}],
    "robot": {"path_m": [[1.6, 1.6], [3.2, 1.8], [2.6, 2.6], [3.4, 2.2], [2.4, 1.4], [3.3, 1.7]], "max_speed_m_s": 0.3},
    "sensors": {"camera": {"preset": "kinect", "rate_hz": 6, "width_px": 320, "height_px": 240, "at_m": [0.06, 0.01, 0.8], "pitch_down_deg": 2, "near_m": 4.9},
                "lidar": {"preset": "rplidar", "rate_hz": 10, "at_m": [0.05, 0, 0.2], "sigma_m": 0.006, "sigma_relative": 0.003},
                "odometry": {"preset": "kobuki", "noise": 0}}
  })";
  const auto simulated =
      call(folder.path(), {"simulate", write("world.json", world), "-o", at("true"), "--quiet"});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const auto done = calibrate({at("true/board.rawlog"), "-o", at("found.ini"), "--json", at("found.json"), "--board",
                               "9x6x0.08", "--pose", "KINECT=0.09,-0.03,0.8,-4,5,2"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("views of the board"));
  const auto found = nlohmann::json::parse(contentOf(folder.file("found.json")));
  const std::map<std::string, double> truth{{"camera x", 0.06}, {"camera y", 0.01}, {"camera yaw", 0}, {"camera pitch", 2 * kDegree},
                                            {"camera roll", 0}, {"camera time offset", 0}};
  std::map<std::string, double> limits{{"m", 0.01}, {"rad", 0.4 * kDegree}, {"s", 0.005}};
  for (const auto& parameter : found.at("parameters")) {
    const std::string name = parameter.at("name");
    const bool hidden = name == "camera z" || name == "depth scale" || name == "depth bias";
    EXPECT_EQ(parameter.at("fixed") == "no", hidden) << parameter;
    const auto expected = truth.find(name);
    if (expected == truth.end()) continue;
    const double off = parameter.at("after").get<double>() - expected->second;
    EXPECT_LT(std::abs(off), limits.at(parameter.at("unit"))) << parameter;
    EXPECT_LT(std::abs(off), 6 * parameter.at("sigma").get<double>()) << parameter;
  }
  expectOneLine(calibrate({at("true/board.rawlog"), "-o", at("c.ini"), "--board", "7x5x0.08", "--quiet"}), 3,
                AllOf(HasSubstr("board.rawlog"), HasSubstr("7 by 5")));
}

TEST_F(CalibrateCommand, ErrorsAreOneLineWithTheirCode) {
  const std::string room = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";
  expectOneLine(calibrate({room}), 2, HasSubstr("-o names"));
  expectOneLine(calibrate({at("none.rawlog"), "-o", at("c.ini")}), 3, HasSubstr("none.rawlog"));
  expectOneLine(calibrate({room, "-o", room}), 2, HasSubstr("tiny_room.rawlog"));
  expectOneLine(calibrate({room, "-o", at("c.ini"), "--lidar", "LIDRA"}), 2, HasSubstr("did you mean"));
  expectOneLine(calibrate({room, "-o", at("c.ini"), "--board", "9x6"}), 2, AllOf(HasSubstr("--board"), HasSubstr("9x6x0.04")));
  expectOneLine(calibrate({room, room, "-o", at("c.ini"), "--rawlog", at("x.rawlog")}), 2,
                HasSubstr("one recording"));
  expectOneLine(
      calibrate({room, "--apply", write("c.ini", "[wheels]\nsize = 1\n"), "--rawlog", at("x.rawlog")}), 2,
      HasSubstr("c.ini:2"));
  expectOneLine(calibrate({room, "--apply", at("c.ini")}), 2, HasSubstr("--rawlog"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
}

}  // namespace
}  // namespace roomgraph
