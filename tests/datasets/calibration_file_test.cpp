// SPDX-License-Identifier: BSD-3-Clause
// Calibration files: reading, refusals, and what they change in the records.
#include "roomgraph/datasets/calibration_file.h"

#include <gmock/gmock.h>

#include <cmath>

#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/corrected_rawlog.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CalibrationFileTest : public ::testing::Test {
 protected:
  Calibration read(const std::string& text) {
    writeBytes(folder.file("c.ini"), text);
    return readCalibration(folder.file("c.ini"));
  }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  std::vector<Record> records(const std::vector<Object>& written, const RecordCorrections& corrections,
                              std::map<std::string, int>* counts = nullptr) {
    writeRawlog(folder.file("x.rawlog"), written);
    RawlogReader reader(folder.file("x.rawlog"), {.corrections = corrections});
    std::vector<Record> out;
    while (auto record = reader.next()) out.push_back(*record);
    if (counts) *counts = reader.statistics().corrected;
    return out;
  }
  TemporaryFolder folder;
};

TEST_F(CalibrationFileTest, ReadsEverySection) {
  const Calibration c = read(
      "[sensor KINECT]\npose = 0.1, 0, 0.9, 0, 10, 0  # looks down\ntime_offset_s = -0.03\n"
      "[sensor front laser]\npose = 0.2,0,0.3,5,0,0\n"
      "[wheels]\nscale = 1.02\nturn_scale = 0.97\ndrift_rad_m = 0.01\ntime_offset_s = 0.02\n"
      "[depth]\nscale = 0.98\nbias_m = 0.01\n");
  EXPECT_TRUE(c.poses.at("KINECT").isApprox(poseFromYpr(0.1, 0, 0.9, 0, 10 * kDegree, 0), 1e-12));
  EXPECT_TRUE(c.poses.at("front laser").isApprox(poseFromYpr(0.2, 0, 0.3, 5 * kDegree, 0, 0), 1e-12));
  EXPECT_EQ(c.corrections.time_offsets_s, (std::map<std::string, double>{{"KINECT", -0.03}}));
  EXPECT_EQ(c.corrections.wheels, (WheelCorrection{1.02, 0.97, 0.01}));
  EXPECT_EQ(c.corrections.wheels_time_offset_s, 0.02);
  EXPECT_EQ(c.corrections.depth, (DepthCorrection{0.98, 0.01}));
  EXPECT_EQ(read("").corrections, RecordCorrections{});
}

TEST_F(CalibrationFileTest, RefusalsNameFileLineAndCause) {
  EXPECT_THAT(refusal("[wheels]\nscael = 1\n"),
              AllOf(HasSubstr("c.ini:2"), HasSubstr("'scael'"), HasSubstr("did you mean 'scale'")));
  EXPECT_THAT(refusal("[wheels]\nscale = 3\n"), AllOf(HasSubstr("c.ini:2"), HasSubstr("[0.5, 2]")));
  EXPECT_THAT(refusal("[camera]\npose = 0,0,0,0,0,0\n"), HasSubstr("unknown section [camera]"));
  EXPECT_THAT(refusal("[sensor A]\npose = 0,0,0\n"),
              AllOf(HasSubstr("c.ini:2"), HasSubstr("3 numbers instead of 6")));
  EXPECT_THAT(refusal("[sensor A]\nscale = 1\n"), HasSubstr("known: pose, time_offset_s"));
  EXPECT_THAT(refusal("[sensor A]\ntime_offset_s = 11\n"), HasSubstr("[-10, 10]"));
  EXPECT_THAT(refusal("[sensor ]\ntime_offset_s = 1\n"), HasSubstr("unknown section [sensor]"));
  EXPECT_THROW(readCalibration(folder.file("none.ini")), InputError);
}

TEST_F(CalibrationFileTest, SensorsThatTheRecordingLacksAreRefused) {
  const auto refused = [&](const RecordCorrections& corrections) -> std::string {
    try {
      records({makeScan(1), makeImages(2)}, corrections);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refused({.time_offsets_s = {{"KINETC", 0.1}}}),
              AllOf(HasSubstr("'KINETC'"), HasSubstr("did you mean 'KINECT'")));
  EXPECT_THAT(refused({.wheels = {1.1, 1, 0}}), AllOf(HasSubstr("odometry"), HasSubstr("there is: none")));
  EXPECT_THAT(refused({.wheels_time_offset_s = 0.1}), HasSubstr("odometry"));
}

TEST_F(CalibrationFileTest, StampsAndDepthsAreCorrected) {
  std::map<std::string, int> counts;
  const auto corrected =
      records({makeScan(1), makeImages(2), makeImages(3)},
              {.time_offsets_s = {{"LASER", 0.25}, {"KINECT", -0.5}}, .depth = {1.1, -0.05}}, &counts);
  ASSERT_EQ(corrected.size(), 3u);
  EXPECT_NEAR(timeOf(corrected[0]), 1.25, 1e-6);
  const auto& frame = std::get<Frame>(corrected[1]);
  EXPECT_NEAR(frame.t, 1.5, 1e-6);
  EXPECT_EQ(frame.depthAt(0, 0), 0) << "what was not measured is not measured afterwards";
  EXPECT_NEAR(frame.depthAt(3, 2), 1.1 * 1.03 - 0.05, 1e-6);
  EXPECT_EQ(counts, (std::map<std::string, int>{{"depth of 'KINECT'", 2},
                                                {"stamp of 'KINECT' -0.5000 s", 2},
                                                {"stamp of 'LASER' +0.2500 s", 1}}));
  records({makeScan(1)}, {}, &counts);
  EXPECT_THAT(counts, IsEmpty());
}

// About the sensor's own place, along the robot's axes.
TEST_F(CalibrationFileTest, PosesAreTurned) {
  const std::vector<Object> written = {makeScan(1), makeImages(2)};
  const auto recorded = records(written, {});
  std::map<std::string, int> counts;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  const auto corrected = records(written, {.turns = {{"KINECT", turn}}}, &counts);
  const Pose3 &before = std::get<Frame>(recorded[1]).robot_from_camera, &after = std::get<Frame>(corrected[1]).robot_from_camera;
  EXPECT_EQ(after.translation(), before.translation());
  EXPECT_LT((after.linear() - turn * before.linear()).norm(), 1e-12);
  EXPECT_GT((after.linear() - before.linear()).norm(), 0.1);
  EXPECT_TRUE(std::get<Scan>(corrected[0]).robot_from_lidar.isApprox(std::get<Scan>(recorded[0]).robot_from_lidar, 1e-12));
  EXPECT_EQ(counts, (std::map<std::string, int>{{"pose of 'KINECT'", 1}}));
  const auto scans = records(written, {.turns = {{"LASER", turn}}});
  EXPECT_LT((std::get<Scan>(scans[0]).robot_from_lidar.linear() - turn * std::get<Scan>(recorded[0]).robot_from_lidar.linear()).norm(), 1e-12);
}

TEST_F(CalibrationFileTest, OdometryIsSummedUpFromCorrectedMovements) {
  // Straight on, a turn on the spot, and straight on again, from a pose that is not the origin.
  const auto corrected = records({makeOdometry(1, 5, 5, M_PI / 2), makeOdometry(2, 5, 6, M_PI / 2),
                                  makeOdometry(3, 5, 6, 0), makeOdometry(4, 7, 6, 0)},
                                 {.wheels_time_offset_s = 0.1, .wheels = {1.1, 0.5, 0}});
  ASSERT_EQ(corrected.size(), 4u);
  const auto pose = [&](std::size_t i) { return std::get<OdometryReading>(corrected[i]).odom_from_robot; };
  EXPECT_NEAR(timeOf(corrected[0]), 1.1, 1e-6);
  EXPECT_NEAR(pose(1).y, 6.1, 1e-9);
  EXPECT_NEAR(pose(2).yaw, M_PI / 4, 1e-9);
  EXPECT_NEAR(pose(3).x, 5 + 2.2 * std::cos(M_PI / 4), 1e-9);
  EXPECT_NEAR(pose(3).y, 6.1 + 2.2 * std::sin(M_PI / 4), 1e-9);
}

// A reader of the copy sees what a reader of the input with the calibration sees.
TEST_F(CalibrationFileTest, ACorrectedCopyIsWhatTheFileSays) {
  const Calibration calibration = read(
      "[sensor KINECT]\npose = 0.1,0,0.9,0,10,0\ntime_offset_s = -0.5\n[sensor LASER]\ntime_offset_s = 0.25\n"
      "[wheels]\nscale = 1.1\ntime_offset_s = 0.1\n[depth]\nscale = 1.25\nbias_m = -0.05\n");
  writeRawlog(folder.file("x.rawlog"), {makeScan(1), makeOdometry(1.1, 0, 0, 0), makeImages(2), makeScan(2.1),
                                        makeOdometry(2.2, 1, 0, 0.3), makeImages(3)});
  writeCorrectedRawlog(folder.file("x.rawlog"), folder.file("y.rawlog"), calibration);
  RawlogReader expected(folder.file("x.rawlog"),
                        {.sensor_poses = calibration.poses, .corrections = calibration.corrections});
  RawlogReader copy(folder.file("y.rawlog"));
  int frames = 0, readings = 0, scans = 0;
  while (const auto record = expected.next()) {
    const auto other = copy.next();
    ASSERT_TRUE(other);
    ASSERT_EQ(other->index(), record->index());
    EXPECT_NEAR(timeOf(*other), timeOf(*record), 1e-6);
    if (const auto* frame = std::get_if<Frame>(&*record)) {
      const auto& same = std::get<Frame>(*other);
      EXPECT_TRUE(same.robot_from_camera.isApprox(frame->robot_from_camera, 1e-9));
      EXPECT_EQ(cv::norm(same.color, frame->color, cv::NORM_INF), 0) << "without loss";
      for (int u = 1; u < 16; ++u)
        EXPECT_NEAR(same.depthAt(u, 2), frame->depthAt(u, 2), 0.00063) << "half a unit";
      EXPECT_EQ(same.depthAt(0, 0), 0);
      ++frames;
    } else if (const auto* reading = std::get_if<OdometryReading>(&*record)) {
      EXPECT_NEAR(std::get<OdometryReading>(*other).odom_from_robot.x, reading->odom_from_robot.x, 1e-9);
      EXPECT_NEAR(std::get<OdometryReading>(*other).odom_from_robot.yaw, reading->odom_from_robot.yaw, 1e-9);
      ++readings;
    } else {
      EXPECT_EQ(std::get<Scan>(*other).ranges_m, std::get<Scan>(*record).ranges_m);
      ++scans;
    }
  }
  EXPECT_FALSE(copy.next());
  EXPECT_EQ(frames + 10 * readings + 100 * scans, 222);
}

// Movements without a stamp take that of the next observation, in the copy as in a run; what is left out is told.
TEST_F(CalibrationFileTest, ACorrectedCopyHasTheMovementsWithoutStamps) {
  writeRawlog(folder.file("x.rawlog"), {makeAction(-1, 1, 0, 0), makeSensoryFrame({makeScan(1)}), makeAction(-1, 0.5, 0, 0.2),
                                        makeSensoryFrame({makeScan(2)}), mrpt::obs::CActionCollection::Create(), makeSensoryFrame({makeScan(3)})});
  const auto left_out = writeCorrectedRawlog(folder.file("x.rawlog"), folder.file("y.rawlog"), read("[wheels]\nscale = 2\n"));
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_NE(left_out[0].find("1 records left out: CActionCollection: no movement"), std::string::npos) << left_out[0];
  RawlogReader expected(folder.file("x.rawlog"), {.corrections = read("[wheels]\nscale = 2\n").corrections}), copy(folder.file("y.rawlog"));
  int readings = 0;
  while (const auto record = expected.next()) {
    const auto other = copy.next();
    ASSERT_TRUE(other);
    ASSERT_EQ(other->index(), record->index());
    EXPECT_NEAR(timeOf(*other), timeOf(*record), 1e-6);
    const auto* reading = std::get_if<OdometryReading>(&*record);
    if (reading) {
      EXPECT_NEAR(std::get<OdometryReading>(*other).odom_from_robot.x, reading->odom_from_robot.x, 1e-9);
    }
    readings += reading != nullptr;
  }
  EXPECT_FALSE(copy.next());
  EXPECT_EQ(readings, 2);
}

TEST_F(CalibrationFileTest, ACorrectedCopyIsWholeOrNotThere) {
  writeRawlog(folder.file("x.rawlog"), {makeScan(1), makeImages(2)});
  const auto write = [&](const Calibration& calibration,
                         const std::function<void(double)>& progress = nullptr) {
    writeCorrectedRawlog(folder.file("x.rawlog"), folder.file("y.rawlog"), calibration, std::nullopt,
                         progress);
  };
  EXPECT_THROW(write({}, [](double) { throw Interrupted("x"); }), Interrupted);
  EXPECT_THROW(write(read("[sensor LASRE]\ntime_offset_s = 1\n")), ConfigError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.rawlog")));
  EXPECT_THROW(writeCorrectedRawlog(folder.file("x.rawlog"), folder.file("x.rawlog"), {}), ConfigError);
  const auto along_rays = makeImages(2);
  along_rays->range_is_depth = false;
  writeRawlog(folder.file("x.rawlog"), {along_rays});
  EXPECT_THROW(write(read("[depth]\nbias_m = 0.1\n")), RunError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.rawlog")));
}

// A drive along an arc, integrated in small steps of what the wheels should have said.
TEST(WheelCorrection, OfAnArcIsTheSumOfSmallSteps) {
  const WheelCorrection correction{1.05, 0.93, 0.2};
  for (const double turn : {0.0, 1e-7, 0.4, -1.3}) {
    constexpr int kSteps = 20000;
    constexpr double kLength = 0.8;
    Pose2 as_read, as_driven;
    for (int i = 0; i < kSteps; ++i) {
      const double length = kLength / kSteps, angle = turn / kSteps;
      as_read = as_read * Pose2{length, 0, angle};
      as_driven = as_driven * Pose2{1.05 * length, 0, 0.93 * angle + 0.2 * 1.05 * length};
    }
    const Pose2 result = corrected(as_read, correction);
    EXPECT_NEAR(result.x, as_driven.x, 1e-4) << turn;
    EXPECT_NEAR(result.y, as_driven.y, 1e-4) << turn;
    EXPECT_NEAR(result.yaw, as_driven.yaw, 1e-9) << turn;
  }
}

}  // namespace
}  // namespace roomgraph::test
