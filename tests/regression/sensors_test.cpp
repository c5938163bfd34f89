// SPDX-License-Identifier: BSD-3-Clause
// Choice of sensors and sensor poses on the command line.
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Runs over a tiny recording whose records can be changed first.
class Sensors : public ::testing::Test {
 protected:
  template <class Change>
  std::filesystem::path write(const std::string& name, const Change& change) {
    auto records = recording.records({true, true, true});
    std::vector<test::Object> all;
    for (const auto& record : records) change(record, all);
    test::writeRawlog(folder.file(name), all);
    return folder.file(name);
  }
  std::filesystem::path writePlain() {
    return write("plain.rawlog", [](const test::Object& record, auto& all) { all.push_back(record); });
  }
  CallResult run(const std::filesystem::path& input, const std::string& output,
                 std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {"run", input.string(), "-o", folder.file(output).string(), "--quiet", "--no-snapshot"});
    return call(folder.path(), more);
  }
  std::string result(const std::string& output, const std::string& name) {
    const std::string text = contentOf(folder.file(output) / name);
    EXPECT_FALSE(text.empty()) << output << "/" << name;
    return text;
  }

  TemporaryFolder folder;
  TinyRecording recording{12};
};

TEST_F(Sensors, ASecondLidarChangesNothingUnlessItIsChosen) {
  // The second one sees every range 20 % too long.
  const auto two = write("two.rawlog", [](const test::Object& record, auto& all) {
    all.push_back(record);
    const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(record);
    if (!scan) return;
    auto rear = std::make_shared<mrpt::obs::CObservation2DRangeScan>(*scan);
    rear->sensorLabel = "REAR";
    for (std::size_t i = 0; i < rear->getScanSize(); ++i) rear->setScanRange(i, 1.2f * rear->getScanRange(i));
    all.push_back(rear);
  });
  EXPECT_THAT(run(writePlain(), "plain").err, Not(HasSubstr("several")));
  const CallResult first = run(two, "first");
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.err,
              AllOf(HasSubstr("'LASER' is used, 'REAR' not"), HasSubstr("--set lidar.label=REAR")));
  EXPECT_THAT(first.out, HasSubstr("12 x CObservation2DRangeScan 'REAR': another sensor was chosen"));
  EXPECT_EQ(result("first", "trajectory.tum"), result("plain", "trajectory.tum"));
  EXPECT_EQ(result("first", "map.pgm"), result("plain", "map.pgm"));
  const auto summary = nlohmann::json::parse(result("first", "summary.json"));
  EXPECT_THAT(summary.at("sensor_warnings").at(0), HasSubstr("'REAR'"));

  const CallResult rear = run(two, "rear", {"--set", "lidar.label=REAR"});
  EXPECT_EQ(rear.exit_code, 0);
  EXPECT_THAT(rear.err, Not(HasSubstr("several")));
  EXPECT_NE(result("rear", "map.pgm"), result("plain", "map.pgm"));
}

TEST_F(Sensors, ASecondCameraChangesNothingUnlessItIsChosen) {
  // It looks backwards, and shows what the first one sees in a mirror.
  const auto two = write("two.rawlog", [](const test::Object& record, auto& all) {
    all.push_back(record);
    const auto images = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(record);
    if (!images) return;
    auto rear = std::make_shared<mrpt::obs::CObservation3DRangeScan>(*images);
    rear->sensorLabel = "BACK";
    rear->sensorPose = mrpt::poses::CPose3D(-0.1, 0, 1, M_PI, 0, 0);
    rear->intensityImage = mrpt::img::CImage(images->intensityImage, mrpt::img::DEEP_COPY);
    rear->intensityImage.flipHorizontal();
    all.push_back(rear);
  });
  const std::vector<std::string> only_images = {"--set", "lidar.enabled=false", "--set", "odometry.enabled=false"};
  EXPECT_EQ(run(writePlain(), "plain", only_images).exit_code, 0);
  const CallResult first = run(two, "first", only_images);
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.err, AllOf(HasSubstr("'RGBD' is used, 'BACK' not"), HasSubstr("--set rgbd.label=BACK")));
  EXPECT_THAT(first.out, HasSubstr("6 x CObservation3DRangeScan 'BACK': another sensor was chosen"));
  EXPECT_EQ(result("first", "trajectory.tum"), result("plain", "trajectory.tum"));

  std::vector<std::string> chosen = only_images;
  chosen.insert(chosen.end(), {"--set", "rgbd.label=BACK"});
  const CallResult back = run(two, "back", chosen);
  EXPECT_EQ(back.exit_code, 0);
  EXPECT_THAT(back.err, Not(HasSubstr("several")));
  EXPECT_THAT(back.out, HasSubstr("6 x CObservation3DRangeScan 'RGBD': another sensor was chosen"));
  EXPECT_NE(result("back", "trajectory.tum"), result("plain", "trajectory.tum"));

  const CallResult info = call(folder.path(), {"info", two.string()});
  EXPECT_THAT(info.out, AllOf(HasSubstr("'RGBD' is used, 'BACK' not"), HasSubstr("--set rgbd.label=BACK")));
}

TEST_F(Sensors, PoseOnTheCommandLineIsThatOfTheRecords) {
  const auto plain = writePlain();
  const auto moved = write("moved.rawlog", [](const test::Object& record, auto& all) {
    if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(record))
      scan->sensorPose = mrpt::poses::CPose3D(0.25, 0.125, 0.5, M_PI / 2, 0, 0);
    all.push_back(record);
  });
  EXPECT_EQ(run(moved, "moved").exit_code, 0);
  EXPECT_EQ(run(plain, "posed", {"--pose", "LASER=0.25,0.125,0.5,90,0,0"}).exit_code, 0);
  EXPECT_EQ(run(plain, "plain").exit_code, 0);
  EXPECT_EQ(result("posed", "trajectory.tum"), result("moved", "trajectory.tum"));
  EXPECT_EQ(result("posed", "map.pgm"), result("moved", "map.pgm"));
  EXPECT_NE(result("posed", "map.pgm"), result("plain", "map.pgm"));

  // The run's own config repeats it.
  EXPECT_EQ(run(plain, "again", {"--config", (folder.file("posed") / "config.ini").string()}).exit_code, 0);
  EXPECT_EQ(result("again", "trajectory.tum"), result("moved", "trajectory.tum"));
}

TEST_F(Sensors, ACalibrationFileTakesThePlaceOfWhatWasRecorded) {
  // Recorded with a lidar at the wrong place whose clock is a quarter of a second late, and wheels that count 10 % too much.
  const auto wrong = write("wrong.rawlog", [](const test::Object& record, auto& all) {
    if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(record)) {
      scan->sensorPose = mrpt::poses::CPose3D(0.25, 0.125, 0.5, M_PI / 2, 0, 0);
      scan->timestamp += std::chrono::milliseconds(250);
    }
    if (const auto wheels = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(record))
      wheels->odometry = {1.1 * wheels->odometry.x(), 1.1 * wheels->odometry.y(), wheels->odometry.phi()};
    all.push_back(record);
  });
  const auto plain = writePlain();
  const mrpt::obs::CObservation2DRangeScan::Ptr scan = [&] {
    for (const auto& record : recording.records({true, true, true}))
      if (auto found = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(record)) return found;
    return mrpt::obs::CObservation2DRangeScan::Ptr();
  }();
  ASSERT_TRUE(scan);
  const auto pose = scan->sensorPose;
  std::ostringstream text;
  text << "[sensor LASER]\npose = " << pose.x() << "," << pose.y() << "," << pose.z() << "," << pose.yaw() * 180 / M_PI
       << ",0,0\ntime_offset_s = -0.25\n[wheels]\nscale = " << std::setprecision(17) << 1 / 1.1 << "\n";
  writeBytes(folder.file("c.ini"), text.str());
  const std::vector<std::string> calibrated{"--calibration", folder.file("c.ini").string()};
  EXPECT_EQ(run(plain, "plain").exit_code, 0);
  EXPECT_EQ(run(wrong, "wrong").exit_code, 0);
  const CallResult done = run(wrong, "calibrated", calibrated);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(result("wrong", "map.pgm"), result("plain", "map.pgm"));
  EXPECT_EQ(result("calibrated", "map.pgm"), result("plain", "map.pgm"));
  const auto applied = nlohmann::json::parse(result("calibrated", "summary.json")).at("calibration");
  EXPECT_EQ(applied.at("file"), folder.file("c.ini").string());
  EXPECT_EQ(applied.at("records_corrected").at("stamp of 'LASER' -0.2500 s"), 12);
  EXPECT_TRUE(applied.at("records_corrected").contains("odometry"));
  EXPECT_TRUE(applied.at("poses").contains("LASER"));
  EXPECT_FALSE(nlohmann::json::parse(result("plain", "summary.json")).contains("calibration"));

  // The run's own config repeats it; --pose goes before the file.
  EXPECT_EQ(run(wrong, "again", {"--config", (folder.file("calibrated") / "config.ini").string()}).exit_code, 0);
  EXPECT_EQ(result("again", "map.pgm"), result("plain", "map.pgm"));
  std::vector<std::string> posed = calibrated;
  posed.insert(posed.end(), {"--pose", "LASER=0.25,0.125,0.5,90,0,0"});
  EXPECT_EQ(run(wrong, "posed", posed).exit_code, 0);
  EXPECT_NE(result("posed", "map.pgm"), result("plain", "map.pgm"));
  EXPECT_EQ(nlohmann::json::parse(result("posed", "summary.json")).at("calibration").at("poses").at("LASER"),
            "0.25,0.125,0.5,90,0,0") << "as it was applied, not as the file has it";

  writeBytes(folder.file("other.ini"), "[sensor LASRE]\ntime_offset_s = 1\n");
  expectOneLine(run(plain, "x", {"--calibration", folder.file("other.ini").string()}), 2,
                AllOf(HasSubstr("'LASRE'"), HasSubstr("did you mean 'LASER'")));
  expectOneLine(run(plain, "x", {"--calibration", folder.file("none.ini").string()}), 3, HasSubstr("none.ini"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("x")));
}

TEST_F(Sensors, WrongLabelsAndPosesAreRefusedBeforeTheReplay) {
  const auto plain = writePlain();
  expectOneLine(run(plain, "x", {"--set", "lidar.label=LASRE"}), 2,
                AllOf(HasSubstr("no lidar 'LASRE'"), HasSubstr("did you mean 'LASER'")));
  expectOneLine(run(plain, "x", {"--set", "rgbd.label=LASER"}), 2, HasSubstr("there is: 'RGBD'"));
  expectOneLine(run(plain, "x", {"--pose", "LASR=0,0,0,0,0,0"}), 2,
                AllOf(HasSubstr("'LASR'"), HasSubstr("'LASER', 'RGBD'")));
  expectOneLine(run(plain, "x", {"--pose", "LASER=0,0,0,0,0"}), 2, HasSubstr("5 numbers instead of 6"));
  expectOneLine(run(plain, "x", {"--set", "pipeline.sensor_poses=LASER"}), 2, HasSubstr("sensor_poses"));
  expectOneLine(call(folder.path(), {"info", plain.string(), "--pose", "LASER=0,0,nan,0,0,0"}), 2,
                HasSubstr("'nan' is not a number"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("x")));
}

TEST_F(Sensors, ImportNamesCamerasAndPlaces) {
  const std::string dir = folder.path().string(), out = folder.file("x.rawlog").string();
  folder.write("associations.txt", "1 rgb/a.png 1 depth/a.png\n");
  expectOneLine(call(folder.path(), {"import", "tum", dir, "-o", out}), 2,
                AllOf(HasSubstr("no fx, fy, cx, cy, depth_scale"), HasSubstr("--camera freiburg1|")));
  expectOneLine(call(folder.path(), {"import", "tum", dir, "-o", out, "--camera", "freiburg9"}), 3,
                AllOf(HasSubstr("freiburg9"), HasSubstr("freiburg1|")));
  expectOneLine(
      call(folder.path(), {"import", "tum", dir, "-o", out, "--camera", "kinect", "--pose", "A=0,0,1,0,0,0"}),
      2, HasSubstr("the only sensor is 'RGBD'"));
  expectOneLine(call(folder.path(), {"import", "tum", dir, "-o", dir, "--camera", "kinect"}), 1,
                HasSubstr("is a folder"));
}

}  // namespace
}  // namespace roomgraph::test
