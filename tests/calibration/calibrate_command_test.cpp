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

TEST_F(CalibrateCommand, ErrorsAreOneLineWithTheirCode) {
  const std::string room = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rawlog";
  expectOneLine(calibrate({room}), 2, HasSubstr("-o names"));
  expectOneLine(calibrate({at("none.rawlog"), "-o", at("c.ini")}), 3, HasSubstr("none.rawlog"));
  expectOneLine(calibrate({room, "-o", room}), 2, HasSubstr("tiny_room.rawlog"));
  expectOneLine(calibrate({room, "-o", at("c.ini"), "--lidar", "LIDRA"}), 2, HasSubstr("did you mean"));
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
