// SPDX-License-Identifier: BSD-3-Clause
// Logs written of rawlogs give the same records again, also by MRPT's own reader of these logs.
#include <gmock/gmock.h>
#include <mrpt/obs/carmen_log_tools.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "carmen_maker.h"
#include "data_folder.h"
#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

void expectSameScan(const CObservation2DRangeScan& scan, const CObservation2DRangeScan& wanted) {
  EXPECT_NEAR(secondsOf(scan), secondsOf(wanted), 2e-6);
  ASSERT_EQ(scan.getScanSize(), wanted.getScanSize());
  EXPECT_NEAR(scan.aperture, wanted.aperture, 1e-5);
  EXPECT_TRUE(scan.rightToLeft);
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    ASSERT_EQ(scan.getScanRangeValidity(i), wanted.getScanRangeValidity(i)) << i;
    if (scan.getScanRangeValidity(i)) {
      EXPECT_NEAR(scan.getScanRange(i), wanted.getScanRange(i), 1e-5) << i;
    }
  }
  EXPECT_NEAR(scan.sensorPose.x(), wanted.sensorPose.x(), 1e-6);
  EXPECT_NEAR(scan.sensorPose.y(), wanted.sensorPose.y(), 1e-6);
  EXPECT_NEAR(scan.sensorPose.yaw(), wanted.sensorPose.yaw(), 1e-6);
  EXPECT_EQ(scan.sensorPose.z(), 0) << "the log is flat";
}

class EveryForm : public ::testing::TestWithParam<bool> {};

TEST_P(EveryForm, GivesTheRecordsOfTheRawlog) {
  const bool old = GetParam();
  const auto room = recordsIn(kTinyRoom);
  const auto scans = only<CObservation2DRangeScan>(room);
  CarmenImportOptions options;
  if (old) {
    options.field_of_view = scans[0]->aperture;
    options.max_range_m = scans[0]->maxRange;
  }
  const ImportedLog log(carmenLog(room, {.old = old}), options);
  EXPECT_THAT(log.result.warnings, IsEmpty());
  EXPECT_THAT(log.result.skipped, IsEmpty());
  const auto again = only<CObservation2DRangeScan>(log.records);
  ASSERT_EQ(again.size(), scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(again[i]->sensorLabel, old ? "FLASER" : "ROBOTLASER1");
    expectSameScan(*again[i], *scans[i]);
  }
  const auto wheels = only<CObservationOdometry>(room),
             wheels_again = only<CObservationOdometry>(log.records);
  ASSERT_EQ(wheels_again.size(), wheels.size());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    EXPECT_NEAR(secondsOf(*wheels_again[i]), secondsOf(*wheels[i]), 2e-6);
    EXPECT_NEAR(wheels_again[i]->odometry.x(), wheels[i]->odometry.x(), 1e-8);
    EXPECT_NEAR(wheels_again[i]->odometry.phi(), wheels[i]->odometry.phi(), 1e-8);
    EXPECT_NEAR(wheels_again[i]->velocityLocal.vx, wheels[i]->velocityLocal.vx, 1e-6);
  }
  for (std::size_t i = 1; i < log.records.size(); ++i)
    EXPECT_LE(secondsOf(*log.records[i - 1]), secondsOf(*log.records[i])) << i;
}

// MRPT's reader knows ranges and poses of sweeps; its times are wrong (2.5.8 takes seconds for nanoseconds),
// and it has neither lines ODOM nor the angle of the first beam.
TEST_P(EveryForm, AgreesWithMrptsReader) {
  const auto text = carmenLog(recordsIn(kTinyRoom), {.old = GetParam(), .wheels = false});
  const ImportedLog log(text);
  std::istringstream in(text);
  std::vector<mrpt::obs::CObservation::Ptr> theirs, some;
  while (mrpt::obs::carmen_log_parse_line(in, some, mrpt::Clock::fromDouble(0)))
    theirs.insert(theirs.end(), some.begin(), some.end());
  const auto scans = only<CObservation2DRangeScan>(log.records),
             their_scans = only<CObservation2DRangeScan>(theirs);
  ASSERT_EQ(scans.size(), 40u);
  ASSERT_EQ(their_scans.size(), scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i]->sensorLabel, their_scans[i]->sensorLabel);
    for (std::size_t k = 0; k < scans[i]->getScanSize(); ++k)
      ASSERT_EQ(scans[i]->getScanRange(k), their_scans[i]->getScanRange(k)) << k;
    EXPECT_NEAR(scans[i]->sensorPose.x(), their_scans[i]->sensorPose.x(), 1e-6);
  }
  const auto wheels = only<CObservationOdometry>(log.records),
             their_wheels = only<CObservationOdometry>(theirs);
  ASSERT_EQ(wheels.size(), 40u);
  ASSERT_EQ(their_wheels.size(), wheels.size());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    EXPECT_NEAR(wheels[i]->odometry.x(), their_wheels[i]->odometry.x(), 1e-12);
    EXPECT_NEAR(wheels[i]->odometry.phi(), their_wheels[i]->odometry.phi(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Carmen, EveryForm, ::testing::Values(false, true));

// The first beam of a sweep that does not lie symmetrically about the robot's axis: start_angle.
TEST(CarmenImport, BeamsPointWhereTheMessageSays) {
  const ImportedLog log(
      "ROBOTLASER1 0 -1.5 2.0 0.5 80 0.01 1 5 1 2 80 4 5 5 10 20 30 40 50 0.3 0.1 0.2 0 0 0 0 0 0 "
      "0 0 100 h 1\nODOM 0 0 0 0 0 0 101 h 2\n");
  const auto scan = only<CObservation2DRangeScan>(log.records).at(0);
  const auto first = scan->sensorPose.yaw() - 0.5 * scan->aperture,
             last = scan->sensorPose.yaw() + 0.5 * scan->aperture;
  EXPECT_NEAR(first, 0.2 - 1.5, 1e-6);
  EXPECT_NEAR(last, 0.2 + 0.5, 1e-6);
  EXPECT_NEAR(scan->sensorPose.x(), 0.3, 1e-6);
  EXPECT_TRUE(scan->getScanRangeValidity(1));
  EXPECT_FALSE(scan->getScanRangeValidity(2)) << "the maximum is no return";
  ASSERT_TRUE(scan->hasIntensity());
  EXPECT_EQ(scan->getScanIntensity(3), 40);
}

// Real sweeps of the Intel Research Lab, written as the public log has them: 180 readings, no angles.
TEST(CarmenImport, RealSweepsKeepTheirAnglesWithoutOptions) {
  const auto rawlog = dataFolder() / "lidar2d" / "intel.rawlog";
  if (!std::filesystem::exists(rawlog)) GTEST_SKIP() << rawlog << " is not there";
  auto wanted = recordsIn(rawlog);
  const ImportedLog log(
      carmenLog(wanted, {.old = true, .start = 976052857, .middle = -0.5 * std::numbers::pi / 180}));
  std::stable_sort(wanted.begin(), wanted.end(),
                   [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  const auto scans = only<CObservation2DRangeScan>(log.records),
             original = only<CObservation2DRangeScan>(wanted);
  ASSERT_EQ(scans.size(), 13631u);
  ASSERT_EQ(original.size(), scans.size());
  EXPECT_FLOAT_EQ(scans[0]->maxRange, 50) << "what stands for no return in this log";
  for (std::size_t i = 0; i < scans.size(); i += 100) {
    expectSameScan(*scans[i], *original[i]);
    EXPECT_NEAR(scans[i]->sensorPose.yaw(), -0.5 * std::numbers::pi / 180, 1e-6);
  }
  const auto wheels = only<CObservationOdometry>(log.records),
             wheels_before = only<CObservationOdometry>(wanted);
  ASSERT_EQ(wheels.size(), wheels_before.size());
  for (std::size_t i = 0; i < wheels.size(); ++i)
    ASSERT_NEAR(wheels[i]->odometry.x(), wheels_before[i]->odometry.x(), 1e-8) << i;
}

TEST(CarmenImport, GzippedIsTheSame) {
  const auto text = carmenLog(recordsIn(kTinyRoom));
  const ImportedLog plain(text);
  const TemporaryFolder folder;
  importCarmen(writeGz(folder, "x.clf.gz", text), folder.file("x.rawlog"));
  EXPECT_EQ(folder.read("x.rawlog"), plain.folder.read("x.rawlog"));
}

TEST(CarmenImport, TruncatedGivesItsBeginning) {
  const auto text = carmenLog(recordsIn(kTinyRoom));
  const ImportedLog cut(text.substr(0, text.size() / 2));
  EXPECT_THAT(cut.result.warnings, ::testing::ElementsAre(HasSubstr("ROBOTLASER1: ends before")));
  EXPECT_GT(cut.records.size(), 50u);
  const TemporaryFolder folder;
  writeGz(folder, "x.gz", text);
  const auto bytes = folder.read("x.gz");
  const auto result =
      importCarmen(folder.write("cut.gz", bytes.substr(0, bytes.size() / 2)), folder.file("y.rawlog"));
  EXPECT_THAT(result.warnings, Contains(HasSubstr("the gzip stream is cut off; what came before is used")));
  EXPECT_GT(result.written.at("ROBOTLASER1"), 10);
}

TEST(CarmenImport, BrokenLinesCostThemselvesOnly) {
  std::string text = carmenLog(recordsIn(kTinyRoom));
  for (int k = 0; k < 5; ++k) text += "ODOM 1 2 x 0 0 0 1700000009 robot 9\n";
  const ImportedLog log(text + "ODOM 1 2 3 0 0 0 9e9 robot 9\nODOM 1 2 3 0 0 0 -5 robot 9\nMARKER a b\n");
  EXPECT_THAT(log.result.warnings, Contains(HasSubstr(": ODOM: the pose is no number; left out")));
  EXPECT_THAT(log.result.warnings, Contains("2 more lines left out"));
  EXPECT_THAT(log.result.skipped, Contains(Pair("ODOM: the pose is no number", 5)));
  EXPECT_THAT(log.result.skipped, Contains(Pair("ODOM: time is not between 1970 and 2200", 2)));
  EXPECT_EQ(only<CObservationOdometry>(log.records).size(), 81u);
}

TEST(CarmenImport, TruthOfTheSimulatorAndCorrectedPoses) {
  const ImportedLog simulated(
      "ODOM 0 0 0 0 0 0 100 h 1\nTRUEPOS 1 2 1.5 0 0 0 100 h 1\nODOM 1 0 0 0 0 0 101 h 2\n");
  EXPECT_EQ(simulated.result.truth, "TRUEPOS, the simulator's");
  double t, x, y, z, qx, qy, qz, qw;
  std::istringstream truth(simulated.folder.read("x.groundtruth.txt"));
  std::string comment;
  std::getline(truth, comment);
  EXPECT_EQ(comment, "# poses of the robot");
  ASSERT_TRUE(truth >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_DOUBLE_EQ(t, 100);
  EXPECT_DOUBLE_EQ(y, 2);
  EXPECT_NEAR(2 * std::atan2(qz, qw), 1.5, 1e-8);
  std::string corrected;
  for (int k = 0; k < 10; ++k)
    corrected += format("FLASER 2 1 2 %.3f %.3f 0.1 %d 0 0 %d h %d\n", 0.9 * k, 0.1 * k, k, k + 100, k);
  EXPECT_EQ(ImportedLog(corrected).result.ground_truth, "");
  const ImportedLog asked(corrected, {.corrected_as_truth = true});
  EXPECT_THAT(asked.folder.read("x.groundtruth.txt"), HasSubstr("103.000000 2.7 0.3 0 0 0"));
  EXPECT_NEAR(only<CObservationOdometry>(asked.records)[3]->odometry.x(), 3, 1e-9)
      << "odometry stays what it was";
}

TEST(CarmenImport, SensorsArePlacedByOptionsAndTimesByTheLogger) {
  const ImportedLog log(
      carmenLog(recordsIn(kTinyRoom)),
      {.times = CarmenTimes::kLogger, .sensor_poses = {{"ROBOTLASER1", poseFromYpr(1, 2, 3, 0.5, 0, 0)}}});
  const auto scan = only<CObservation2DRangeScan>(log.records).at(0);
  EXPECT_NEAR(scan->sensorPose.z(), 3, 1e-9);
  EXPECT_NEAR(scan->sensorPose.yaw(), 0.5, 1e-9);
  EXPECT_NEAR(secondsOf(*only<CObservationOdometry>(log.records)[1]), 0.1, 1e-5);
}

TEST(CarmenImport, WhatIsNoLogIsAnErrorInOneLine) {
  const TemporaryFolder folder;
  const auto error = [&](const std::filesystem::path& log) {
    return messageOf<InputError>([&] { importCarmen(log, folder.file("y.rawlog")); });
  };
  EXPECT_THAT(error(folder.write("empty.log", "")), HasSubstr("empty.log: no message of a CARMEN log"));
  EXPECT_THAT(error(kTinyRoom), HasSubstr("no message of a CARMEN log"));
  EXPECT_THAT(error(folder.write("cut.log", "FLASER 180 1.5 2.25")),
              HasSubstr("cut.log: nothing in it can be used; line 1: FLASER: ends before the last reading"));
  EXPECT_THAT(error(folder.file("no.log")), HasSubstr("no such file"));
  const auto log = folder.write("x.log", "ODOM 0 0 0 0 0 0 100 h 1\nODOM 1 0 0 0 0 0 101 h 2\n");
  EXPECT_THAT(messageOf<ConfigError>([&] { importCarmen(log, log); }), HasSubstr("is read by this import"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.rawlog")));
}

}  // namespace
}  // namespace roomgraph
