// SPDX-License-Identifier: BSD-3-Clause
// Report about a rawlog: statistics and findings on synthetic and real recordings.
#include "roomgraph/datasets/rawlog_report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "data_folder.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using testing::Contains;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

testing::Matcher<Finding> findingOf(Severity severity, const std::string& text) {
  return testing::AllOf(Field(&Finding::severity, severity), Field(&Finding::what, HasSubstr(text)));
}

class Doctor : public testing::Test {
 protected:
  RawlogReport inspect(const std::vector<Object>& objects) {
    writeRawlog(folder_.file("x.rawlog"), objects);
    return inspectRawlog(folder_.file("x.rawlog"));
  }
  std::vector<Finding> findings(const std::vector<Object>& objects) { return inspect(objects).findings; }
  TemporaryFolder folder_;
};

TEST_F(Doctor, HealthyRecordingHasOnlyNotes) {
  std::vector<Object> objects;
  for (int i = 0; i < 10; ++i) {
    objects.push_back(makeOdometry(0.1 * i, 0.1 * i, 0, 0));
    objects.push_back(makeScan(0.1 * i + 0.02, 2 + 0.1f * static_cast<float>(i)));
    objects.push_back(makeImages(0.1 * i + 0.05));
  }
  const auto report = inspect(objects);
  EXPECT_THAT(report.findings, Each(Field(&Finding::severity, Severity::kNote)));
  EXPECT_EQ(report.format, "observations");
  EXPECT_EQ(report.records, 30);
  EXPECT_NEAR(report.duration(), 0.95, 1e-6);
  ASSERT_EQ(report.sensors.size(), 3u);
  EXPECT_EQ(report.sensors[0].label, "ODOMETRY");
  EXPECT_NEAR(report.sensors[0].odometry->path_length_m, 0.9, 1e-9);
  EXPECT_NEAR(report.sensors[1].rate_hz, 10, 1e-4);
  EXPECT_EQ(report.sensors[1].scans->beams, 5);
  EXPECT_NEAR(report.sensors[1].scans->valid_share, 1, 1e-12);
  const auto& images = *report.sensors[2].images;
  EXPECT_EQ(images.color, 10);
  EXPECT_DOUBLE_EQ(images.color_camera.fx, 20);
  EXPECT_TRUE(images.registered);
  EXPECT_NEAR(images.median_depth_m, 1.07, 0.08);
  EXPECT_EQ(images.color_distortion, Distortion{}) << "of none";
}

TEST_F(Doctor, TellsTheLensesOfColourAndDepth) {
  auto images = makeImages(0);
  images->cameraParamsIntensity.setDistortionKannalaBrandt(0.1, 0.2, 0.3, 0.4);
  images->cameraParams.setDistortionPlumbBob(0.1, 0.2, 0.3, 0.4, 0.5);
  const auto report = inspect({images});
  ASSERT_EQ(report.sensors.size(), 1u);
  EXPECT_EQ(report.sensors[0].images->color_distortion, (Distortion{"equidistant", {0.1, 0.2, 0.3, 0.4}}));
  EXPECT_EQ(report.sensors[0].images->depth_distortion, (Distortion{"plumb_bob", {0.1, 0.2, 0.3, 0.4, 0.5}}));
}

TEST_F(Doctor, TimeStamps) {
  auto timeless = makeScan(1);
  timeless->timestamp = INVALID_TIMESTAMP;
  EXPECT_THAT(findings({makeScan(1), timeless}),
              Contains(findingOf(Severity::kWarning, "1 of 2 records have no valid")));
  EXPECT_THAT(findings({makeScan(1), makeScan(1), makeScan(1)}),
              Contains(findingOf(Severity::kError, "equal")));
  EXPECT_THAT(
      findings({makeScan(1), makeScan(3), makeScan(2), makeScan(4)}),
      Contains(findingOf(Severity::kWarning, "1 records are older than the one before; first: record 2")));
  EXPECT_THAT(findings({makeScan(1), makeScan(1.1), makeScan(1.2), makeScan(9)}),
              Contains(findingOf(Severity::kWarning, "gap of 7.8 s after t = 1.200")));
  EXPECT_THAT(findings({makeScan(5), makeImages(2), makeScan(6)}),
              Contains(findingOf(Severity::kWarning, "out of order by up to 3.000 s")));
}

TEST_F(Doctor, DepthImages) {
  auto metres = makeImages(1), tiny = makeImages(1), empty = makeImages(1), moved = makeImages(1),
       bare = makeImages(1);
  metres->rangeUnits = 1;
  tiny->rangeUnits = 1e-5f;
  empty->rangeImage.fill(0);
  moved->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, -0.03, 0, -M_PI / 2, 0, -M_PI / 2);
  bare->hasRangeImage = false;
  EXPECT_THAT(findings({metres}), Contains(findingOf(Severity::kError, "the depth unit (1 m) is wrong")));
  EXPECT_THAT(findings({tiny}), Contains(findingOf(Severity::kError, "the depth unit (1e-05 m) is wrong")));
  EXPECT_THAT(findings({empty}), Contains(findingOf(Severity::kError, "depth images are empty")));
  EXPECT_THAT(findings({moved}), Contains(findingOf(Severity::kNote, "not registered")));
  EXPECT_THAT(findings({bare}), Contains(findingOf(Severity::kWarning, "colour without depth")));
}

TEST_F(Doctor, Intrinsics) {
  auto none = makeImages(1), corner = makeImages(1);
  none->cameraParamsIntensity.setIntrinsicParamsFromValues(0, 0, 0, 0);
  corner->cameraParamsIntensity.setIntrinsicParamsFromValues(20, 20, 0, 0);
  EXPECT_THAT(findings({none}), Contains(findingOf(Severity::kError, "no colour intrinsics")));
  EXPECT_THAT(findings({corner}), Contains(findingOf(Severity::kWarning, "principal point")));
  auto outside = makeImages(1);
  outside->cameraParamsIntensity.setIntrinsicParamsFromValues(20, 20, 9999, 5.5);
  EXPECT_THAT(findings({outside}),
              Contains(findingOf(Severity::kError, "colour principal point (9999.0, 5.5) lies outside")));
}

TEST_F(Doctor, SeveralSensorsOfAKind) {
  auto rear = makeScan(1.1), other = makeScan(1.2);
  rear->sensorLabel = "REAR";
  auto camera = makeImages(1.3), right = makeImages(1.4);
  right->sensorLabel = "RIGHT";
  auto visual = makeOdometry(1.6, 0, 0, 0);
  visual->sensorLabel = "VISUAL";
  const auto list = findings({makeScan(1), rear, other, camera, right, makeOdometry(1.5, 0, 0, 0), visual});
  EXPECT_THAT(list, Contains(findingOf(Severity::kWarning, "(lidar): 'LASER' is used, 'REAR' not")));
  EXPECT_THAT(list, Contains(findingOf(Severity::kWarning, "(RGB-D camera): 'KINECT' is used, 'RIGHT' not")));
  EXPECT_THAT(list, Contains(findingOf(Severity::kWarning, "(odometry): 'ODOMETRY' is used, 'VISUAL' not")));
  EXPECT_THAT(list, Contains(Field(&Finding::hint, HasSubstr("--set lidar.label=REAR"))));
  EXPECT_THAT(findings({makeScan(1), makeImages(1.1), makeOdometry(1.2, 0, 0, 0)}),
              Not(Contains(findingOf(Severity::kWarning, "several"))));
}

/// Odometry and scans in turn; the scans' clock is `offset` ahead and runs `rate` times as fast.
std::vector<Object> twoClocks(double offset, double rate) {
  std::vector<Object> objects;
  for (int i = 0; i < 40; ++i) {
    objects.push_back(makeOdometry(10000 + 0.1 * i, 0.1 * i, 0, 0));
    objects.push_back(makeScan(10000 + offset + rate * (0.1 * i + 0.05), 2 + 0.1f * static_cast<float>(i)));
  }
  return objects;
}

TEST_F(Doctor, ClocksOfTheSensors) {
  const auto quiet = Not(Contains(Field(&Finding::what, HasSubstr("clock"))));
  EXPECT_THAT(findings(twoClocks(0, 1)), quiet);
  EXPECT_THAT(findings(twoClocks(-0.4, 1)), quiet) << "delays are no other clock";
  for (const double offset : {-3600.0, 2.0}) {
    const auto apart = findings(twoClocks(offset, 1));
    const std::string text = offset < 0 ? "its clock is -3600.0 s apart" : "its clock is 2.0 s apart";
    EXPECT_THAT(apart, Contains(findingOf(Severity::kError, text + " from that of ODOMETRY")));
    EXPECT_THAT(apart, Not(Contains(findingOf(Severity::kWarning, "out of order by")))) << "not the cause";
  }
  EXPECT_THAT(findings(twoClocks(0, 1000)), Contains(findingOf(Severity::kError, "runs at another speed")));
}

TEST_F(Doctor, SensorsThatNeverRanTogether) {
  std::vector<Object> objects;
  for (int i = 0; i < 10; ++i) objects.push_back(makeOdometry(1000 + 0.1 * i, 0.1 * i, 0, 0));
  for (int i = 0; i < 10; ++i) objects.push_back(makeScan(5000 + 0.1 * i, 2 + 0.1f * static_cast<float>(i)));
  EXPECT_THAT(findings(objects), Contains(findingOf(Severity::kError, "has no time in common with LASER")));
}

TEST_F(Doctor, PosesCanBeTried) {
  writeRawlog(folder_.file("x.rawlog"), {makeScan(1)});
  const auto report =
      inspectRawlog(folder_.file("x.rawlog"), nullptr, parseSensorPoses("LASER=1,2,3,0,0,0", ""));
  EXPECT_NEAR(report.sensors.at(0).robot_from_sensor->translation().z(), 3, 1e-9);
  EXPECT_THROW(inspectRawlog(folder_.file("x.rawlog"), nullptr, parseSensorPoses("LASR=1,2,3,0,0,0", "")),
               ConfigError);
}

TEST_F(Doctor, MissingImages) {
  auto lost = makeImages(1);
  lost->intensityImage.setExternalStorage("lost.jpg");
  const auto report = inspect({lost, makeScan(1.1)});
  EXPECT_THAT(report.findings, Contains(findingOf(Severity::kError, "1 of 1 records lack their image file")));
  EXPECT_THAT(report.sensors[0].images->first_missing, HasSubstr("lost.jpg"));
}

TEST_F(Doctor, ScanGeometry) {
  auto wide = makeScan(1), degrees = makeScan(1, 2, 180), far = makeScan(1), blind = makeScan(1),
       good = makeScan(1, 2, 181);
  wide->aperture = 180;  // degrees given as radians
  degrees->aperture = good->aperture = static_cast<float>(M_PI);
  for (std::size_t i = 0; i < 5; ++i) {
    far->setScanRange(i, far->maxRange);
    blind->setScanRangeValidity(i, false);
  }
  EXPECT_THAT(findings({wide}), Contains(findingOf(Severity::kWarning, "aperture of 180 rad is impossible")));
  EXPECT_THAT(findings({degrees}), Contains(findingOf(Severity::kNote, "180 beams over 180.00 deg")));
  EXPECT_THAT(findings({good}), Not(Contains(findingOf(Severity::kNote, "beams over"))));
  auto one_more = makeScan(1, 2, 361);
  one_more->aperture = static_cast<float>(180.5 * M_PI / 180);
  EXPECT_THAT(findings({one_more}), Contains(findingOf(Severity::kNote, "361 beams over 180.50 deg")));
  for (const double aperture : {360.0, 359.0}) {  // the circle closes at the last beam, or one beam later
    auto circle = makeScan(1, 2, 360);
    circle->aperture = static_cast<float>(aperture * M_PI / 180);
    EXPECT_THAT(findings({circle}), Not(Contains(findingOf(Severity::kNote, "beams over")))) << aperture;
  }
  EXPECT_THAT(findings({far}), Contains(findingOf(Severity::kError, "all ranges are at the maximum (8.00 m)")));
  EXPECT_THAT(findings({blind}), Contains(findingOf(Severity::kError, "all ranges are invalid")));
}

/// Turning on the spot, 0.15 rad each, in a room without symmetry; scans of 181 beams over 180 degrees. Odometry of some turns, but
/// for the first so many of each four, says two fifths more. `forward_m`: it says that the robot drives on meanwhile.
std::vector<Object> turningRobot(double declared_aperture, bool mirrored, int right_of_four = 4, double forward_m = 0,
                                 double roll = 0) {
  const auto wall = [](double a) {
    return 3 + std::sin(a + 1) + 0.6 * std::cos(2 * a) + 0.4 * std::sin(5 * a + 2);
  };
  std::vector<Object> objects;
  double yaw = 0;
  for (int k = 0; k < 20; ++k) {
    auto scan = makeScan(k, 2, 181);
    scan->aperture = static_cast<float>(declared_aperture);
    scan->sensorPose.setYawPitchRoll(0, 0, roll);
    for (int i = 0; i < 181; ++i) {
      const double beam = (i - 90) * M_PI / 180 * (mirrored ? -1 : 1);
      scan->setScanRange(static_cast<std::size_t>(i), static_cast<float>(wall(beam + 0.15 * k)));
    }
    if (k > 0) yaw += k % 4 < right_of_four ? 0.15 : 0.21;
    objects.push_back(makeOdometry(k, forward_m * k, 0, yaw));
    objects.push_back(scan);
  }
  return objects;
}

TEST_F(Doctor, ApertureIsComparedWithOdometry) {
  const auto right = inspect(turningRobot(M_PI, false));
  ASSERT_TRUE(right.sensors[1].scans->rotation_ratio);
  EXPECT_NEAR(*right.sensors[1].scans->rotation_ratio, 1, 0.07);
  EXPECT_THAT(findings(turningRobot(M_PI / 2, false)),
              Contains(findingOf(Severity::kWarning, "odometry turns 1.9")));
  EXPECT_THAT(findings(turningRobot(M_PI, true)), Contains(findingOf(Severity::kWarning, "mirrored")));
  EXPECT_THAT(findings(turningRobot(M_PI, true, 4, 0, M_PI)), Not(Contains(findingOf(Severity::kWarning, "mirrored"))))
      << "mounted upside down, and said to be";
  EXPECT_THAT(findings(turningRobot(M_PI, false, 4, 0, M_PI)), Contains(findingOf(Severity::kWarning, "mirrored")));
  EXPECT_THAT(findings(turningRobot(M_PI, false, 0)), Contains(findingOf(Severity::kWarning, "odometry turns 1.3")));
  EXPECT_TRUE(inspect(turningRobot(M_PI, false, 0, 0.05)).sensors[1].scans->rotation_ratio);
  EXPECT_FALSE(inspect(turningRobot(M_PI, false, 0, 0.07)).sensors[1].scans->rotation_ratio) << "an arc, past walls";
  EXPECT_FALSE(inspect(turningRobot(M_PI, false, 2)).sensors[1].scans->rotation_ratio) << "some turns say that all is well";
}

TEST_F(Doctor, OdometryThatNeverChanges) {
  const auto still = [](double t) { return makeOdometry(t, 1, 1, 1); };
  EXPECT_THAT(findings({still(1), makeScan(1, 2), still(2), makeScan(2, 4)}),
              Contains(findingOf(Severity::kError, "never changes while the scans do")));
  EXPECT_THAT(findings({still(1), makeScan(1, 2), still(2), makeScan(2, 2)}),
              Contains(findingOf(Severity::kNote, "odometry never changes")));
}

TEST_F(Doctor, WholeFile) {
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->timestamp = mrpt::Clock::fromDouble(1);
  const auto useless = findings({comment, makeOdometry(1, 0, 0, 0)});
  EXPECT_THAT(useless, Contains(findingOf(Severity::kError, "no usable sensor")));
  EXPECT_THAT(useless, Contains(findingOf(Severity::kNote, "CObservationComment are not used")));
  EXPECT_EQ(useless.front().severity, Severity::kError) << "worst first";
  EXPECT_THAT(findings({makeScan(1)}), Contains(findingOf(Severity::kNote, "no odometry")));

  auto tilted = makeScan(2);
  tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 1, 0, 0, 0);
  EXPECT_THAT(findings({makeScan(1), tilted}),
              Contains(findingOf(Severity::kNote, "pose on the robot changes")));

  const std::string bytes = bytesOf(makeScan(1)) + bytesOf(makeScan(2));
  writeBytes(folder_.file("cut.rawlog"), bytes.substr(0, bytes.size() - 9));
  EXPECT_THAT(inspectRawlog(folder_.file("cut.rawlog")).findings,
              Contains(findingOf(Severity::kWarning, "ends in the middle")));
  EXPECT_THROW(inspectRawlog(folder_.file("none.rawlog")), InputError);
}

// What a run of the first seconds does not replay is not read for it either.
TEST_F(Doctor, LooksAtTheFirstSecondsWhenAskedTo) {
  std::vector<Object> objects;
  for (int i = 0; i < 100; ++i) objects.push_back(makeScan(10 + 0.1 * i));
  auto tilted = makeScan(20);
  tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 1, 0, 0, 0);
  objects.push_back(tilted);
  writeRawlog(folder_.file("x.rawlog"), objects);
  std::vector<double> shares;
  const auto report = inspectRawlog(folder_.file("x.rawlog"), [&](double share) { shares.push_back(share); }, {}, 3);
  EXPECT_NEAR(report.duration(), 3, 0.5) << "up to the first record after it, and those that wait to be compared";
  EXPECT_DOUBLE_EQ(shares.back(), 1);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_THAT(report.findings, Not(Contains(findingOf(Severity::kNote, "pose on the robot changes"))));
  EXPECT_THAT(inspectRawlog(folder_.file("x.rawlog"), nullptr, {}, 30).findings,
              Contains(findingOf(Severity::kNote, "pose on the robot changes")));
}

// Both sensors are looked at for three seconds, whatever their clocks say, and so is an end that comes before.
TEST_F(Doctor, TheFirstSecondsAreThoseOfEverySensor) {
  std::vector<Object> objects;
  for (int i = 0; i < 100; ++i) {
    objects.push_back(makeScan(10 + 0.1 * i));
    objects.push_back(makeImages(110 + 0.1 * i));
  }
  writeRawlog(folder_.file("x.rawlog"), objects);
  const auto report = inspectRawlog(folder_.file("x.rawlog"), nullptr, {}, 3);
  ASSERT_EQ(report.sensors.size(), 2u);
  for (const auto& sensor : report.sensors) EXPECT_NEAR(sensor.count, 31, 5);
  EXPECT_THAT(report.findings, Contains(findingOf(Severity::kError, "its clock is 100.0 s apart")));
}

TEST_F(Doctor, ActionFormat) {
  const auto report = inspect({makeAction(-1, 1, 0, 0), makeSensoryFrame({makeScan(1)}),
                               makeAction(2, 1, 0, 0.5), makeSensoryFrame({makeScan(2.1)})});
  EXPECT_EQ(report.format, "actions and sensory frames");
  EXPECT_NEAR(report.sensors[0].odometry->path_length_m, 1, 1e-9) << "the first action is where odometry begins";
  EXPECT_NEAR(report.sensors[0].odometry->turn_rad, 0.5, 1e-9);
  EXPECT_THAT(report.findings, Contains(findingOf(Severity::kNote, "1 of 2 actions have no time stamp")));
  const auto damaged =
      inspect({makeAction(1, 1e12, 0, 0), makeSensoryFrame({makeScan(1)}), makeAction(2, 1, 0, 0.5)});
  EXPECT_EQ(damaged.skipped.size(), 1u);
  const auto& actions = damaged.sensors.at(0);
  EXPECT_EQ(actions.class_name, "CActionCollection");
  EXPECT_EQ(actions.count, 1) << "what was skipped is not counted again";
  EXPECT_EQ(actions.invalid_times, 0);
}

TEST(DoctorOnRealData, LabRecordingIsWell) {
  const auto file = dataFolder() / "lab/lab_a/lab_a.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing: " << file;
  const auto report = inspectRawlog(file);
  EXPECT_THAT(report.findings, Each(Field(&Finding::severity, Severity::kNote)));
  ASSERT_EQ(report.sensors.size(), 3u);
  for (const auto& sensor : report.sensors) EXPECT_EQ(sensor.count, sensor.odometry ? 1447 : 724);
}

}  // namespace
}  // namespace roomgraph
