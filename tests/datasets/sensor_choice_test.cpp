// SPDX-License-Identifier: BSD-3-Clause
// Choice among several sensors by label, and sensor poses given as text.
#include <gmock/gmock.h>

#include "errors_of.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using roomgraph::test::messageOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

mrpt::obs::CObservation2DRangeScan::Ptr scanOf(const std::string& label, double t) {
  auto scan = makeScan(t);
  scan->sensorLabel = label;
  return scan;
}

mrpt::obs::CObservation3DRangeScan::Ptr imagesOf(const std::string& label, double t) {
  auto images = makeImages(t);
  images->sensorLabel = label;
  return images;
}

mrpt::obs::CObservationOdometry::Ptr odometryOf(const std::string& label, double t, double x) {
  auto odometry = makeOdometry(t, x, 0, 0);
  odometry->sensorLabel = label;
  return odometry;
}

/// What came out of a reader, by kind; its statistics.
struct Content {
  std::vector<Frame> frames;
  std::vector<Scan> scans;
  std::vector<OdometryReading> odometry;
  ReadStatistics statistics;
};

class SensorChoiceTest : public ::testing::Test {
 protected:
  /// Two of each kind, alternating.
  void writeTwoOfEach() {
    std::vector<Object> objects;
    for (int i = 0; i < 3; ++i) {
      objects.insert(objects.end(), {scanOf("FRONT", i), scanOf("REAR", i + 0.1), imagesOf("LEFT", i + 0.2),
                                     imagesOf("RIGHT", i + 0.3), odometryOf("WHEELS", i + 0.4, 1),
                                     odometryOf("VISUAL", i + 0.5, 2)});
    }
    writeRawlog(file, objects);
  }
  Content read(const ReadOptions& options = {}) const {
    RawlogReader reader(file, options);
    Content out;
    while (auto record = reader.next()) {
      if (auto* frame = std::get_if<Frame>(&*record)) out.frames.push_back(std::move(*frame));
      if (auto* scan = std::get_if<Scan>(&*record)) out.scans.push_back(std::move(*scan));
      if (auto* reading = std::get_if<OdometryReading>(&*record)) out.odometry.push_back(*reading);
    }
    out.statistics = reader.statistics();
    return out;
  }
  std::string refusal(const ReadOptions& options) const {
    return messageOf<ConfigError>([&] { RawlogReader reader(file, options); });
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder.file("x.rawlog");
};

TEST_F(SensorChoiceTest, FirstOfEachKindIsUsedAndBothAreNamed) {
  writeTwoOfEach();
  const Content content = read();
  ASSERT_EQ(content.frames.size(), 3u);
  ASSERT_EQ(content.scans.size(), 3u);
  ASSERT_EQ(content.odometry.size(), 3u);
  EXPECT_EQ(content.frames[2].sensor_label, "LEFT");
  EXPECT_EQ(content.frames[2].id.value, 2) << "frames are numbered as they come out";
  EXPECT_EQ(content.scans[2].sensor_label, "FRONT");
  EXPECT_DOUBLE_EQ(content.odometry[2].odom_from_robot.x, 1);
  EXPECT_THAT(content.statistics.skipped,
              ElementsAre(Pair("CObservation2DRangeScan 'REAR': another sensor was chosen", 3),
                          Pair("CObservation3DRangeScan 'RIGHT': another sensor was chosen", 3),
                          Pair("CObservationOdometry 'VISUAL': another sensor was chosen", 3)));
  EXPECT_THAT(
      content.statistics.sensor_warnings,
      ElementsAre(AllOf(HasSubstr("'LEFT' is used, 'RIGHT' not"), HasSubstr("--set rgbd.label=RIGHT")),
                  AllOf(HasSubstr("'FRONT' is used, 'REAR' not"), HasSubstr("--set lidar.label=REAR")),
                  AllOf(HasSubstr("'WHEELS' is used, 'VISUAL' not"), HasSubstr("odometry.label=VISUAL"))));
}

TEST_F(SensorChoiceTest, LabelsChoose) {
  writeTwoOfEach();
  const Content content = read({.rgbd_label = "RIGHT", .lidar_label = "REAR", .odometry_label = "VISUAL"});
  ASSERT_EQ(content.frames.size(), 3u);
  EXPECT_EQ(content.frames[0].sensor_label, "RIGHT");
  ASSERT_EQ(content.scans.size(), 3u);
  EXPECT_EQ(content.scans[0].sensor_label, "REAR");
  ASSERT_EQ(content.odometry.size(), 3u);
  EXPECT_DOUBLE_EQ(content.odometry[0].odom_from_robot.x, 2);
  EXPECT_THAT(content.statistics.sensor_warnings, IsEmpty()) << "the user knows";
  EXPECT_EQ(content.statistics.skipped.at("CObservation2DRangeScan 'FRONT': another sensor was chosen"), 3);
}

// Two cameras on one robot, one looking ahead and one to the left: what comes out is one of them, where it is.
TEST_F(SensorChoiceTest, ACameraComesWithItsOwnMount) {
  const mrpt::poses::CPose3D ahead(0.1, 0, 1.2, 0, 0, 0), left(0, 0.2, 0.8, M_PI / 2, 0, 0);
  std::vector<Object> objects;
  for (int i = 0; i < 3; ++i) {
    objects.push_back(imagesOf("AHEAD", i));
    std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(objects.back())->sensorPose = ahead;
    objects.push_back(imagesOf("LEFT", i + 0.01));
    std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(objects.back())->sensorPose = left;
  }
  writeRawlog(file, objects);
  const auto optical = toPose3(makeImages(0)->relativePoseIntensityWRTDepth);
  for (const auto& [label, mount] : {std::pair{"AHEAD", ahead}, std::pair{"LEFT", left}}) {
    const Content content = read({.rgbd_label = label});
    ASSERT_EQ(content.frames.size(), 3u) << label;
    for (const Frame& frame : content.frames) {
      EXPECT_EQ(frame.sensor_label, label);
      EXPECT_TRUE(frame.robot_from_camera.isApprox(toPose3(mount) * optical, 1e-9)) << label;
    }
  }
}

TEST_F(SensorChoiceTest, TwoCamerasWithOneLabelAreNotMixed) {
  const auto other = [](double t) {
    auto images = makeImages(t);
    images->cameraParams.setIntrinsicParamsFromValues(21, 21, 7.5, 5.5);  // 20 px; 2 % of 16 px is 0.32 px
    images->cameraParamsIntensity = images->cameraParams;
    return images;
  };
  const auto recalibrated = [](double t) {
    auto images = makeImages(t);
    images->cameraParams.setIntrinsicParamsFromValues(20.1, 20.1, 7.5, 5.5);
    images->cameraParamsIntensity = images->cameraParams;
    return images;
  };
  writeRawlog(file, {makeImages(1), other(1.1), makeImages(2), other(2.1), recalibrated(3), makeImages(4, 32, 24)});
  const Content content = read();
  ASSERT_EQ(content.frames.size(), 3u);
  for (const Frame& frame : content.frames) EXPECT_NEAR(frame.camera.fx, 20, 0.2);
  EXPECT_EQ(content.frames[2].id.value, 2) << "frames are numbered as they come out";
  EXPECT_THAT(content.statistics.skipped,
              ElementsAre(Pair("CObservation3DRangeScan 'KINECT': not the camera of the first image: several "
                               "cameras have this label",
                               3)));
}

// Of one model and with one label, a camera that looks ahead and one that looks to the left.
TEST_F(SensorChoiceTest, TwoEqualCamerasWithOneLabelAreToldApartByTheirMounts) {
  std::vector<Object> objects;
  for (int i = 0; i < 5; ++i)
    for (const double yaw : {0.0, M_PI / 2}) {
      const auto images = makeImages(i * 0.1 + yaw * 0.03);
      images->sensorPose = mrpt::poses::CPose3D(0.1, 0, 1.2, yaw, 0, 0);
      objects.push_back(images);
    }
  writeRawlog(file, objects);
  const Content content = read();
  ASSERT_EQ(content.frames.size(), 5u);
  for (const Frame& frame : content.frames)
    EXPECT_TRUE(frame.robot_from_camera.isApprox(content.frames[0].robot_from_camera));
  EXPECT_EQ(content.statistics.skipped.begin()->second, 5);
}

TEST_F(SensorChoiceTest, AHeadThatPansIsOneCamera) {
  std::vector<Object> objects;
  for (int i = 0; i < 20; ++i) {
    const auto images = makeImages(i * 0.1);
    images->sensorPose = mrpt::poses::CPose3D(0.1, 0, 1.2 + 0.03 * i, 0.2 * i, 0, 0);  // 2 rad/s, .3 m/s
    objects.push_back(images);
  }
  writeRawlog(file, objects);
  EXPECT_EQ(read().frames.size(), 20u);
}

TEST_F(SensorChoiceTest, WhatHasNoLabelCannotBeChosen) {
  const auto advice = [&](const std::vector<Object>& objects) {
    writeRawlog(file, objects);
    return read().statistics.sensor_warnings.at(0);
  };
  EXPECT_THAT(advice({scanOf("FRONT", 1), scanOf("", 1.1)}),
              AllOf(HasSubstr("'FRONT' is used, '' not; a sensor without a label cannot be chosen"),
                    Not(HasSubstr("--set"))));
  EXPECT_THAT(advice({scanOf("FRONT", 1), scanOf("", 1.1), scanOf("REAR", 1.2)}),
              EndsWith("choose with --set lidar.label=REAR"));
  EXPECT_THAT(advice({scanOf("", 1), scanOf("REAR", 1.2)}), EndsWith("choose with --set lidar.label=REAR"));
}

TEST_F(SensorChoiceTest, OneOfEachKindNeedsNoWord) {
  writeRawlog(file, {scanOf("A", 1), imagesOf("A", 1.1), odometryOf("A", 1.2, 1), scanOf("A", 2)});
  const Content content = read();
  EXPECT_EQ(content.scans.size(), 2u);
  EXPECT_EQ(content.frames.size(), 1u);
  EXPECT_THAT(content.statistics.sensor_warnings, IsEmpty());
  EXPECT_THAT(content.statistics.skipped, IsEmpty());
}

TEST_F(SensorChoiceTest, KindsThatAreOffAreNotWarnedAbout) {
  writeTwoOfEach();
  const Content content = read({.frames = true, .scans = false, .odometry = false, .lidar_label = "NONE"});
  ASSERT_EQ(content.statistics.sensor_warnings.size(), 1u);
  EXPECT_THAT(content.statistics.sensor_warnings[0], HasSubstr("'LEFT'"));
  EXPECT_EQ(content.statistics.skipped.at("CObservation2DRangeScan: not asked for"), 6);
}

TEST_F(SensorChoiceTest, SensoryFramesAndActions) {
  writeRawlog(
      file, {makeAction(1, 1, 0, 0), makeSensoryFrame({scanOf("FRONT", 1.1), scanOf("REAR", 1.2)}),
             makeAction(2, 1, 0, 0), makeSensoryFrame({scanOf("FRONT", 2.1), odometryOf("WHEELS", 2.2, 9)})});
  const Content first = read();
  EXPECT_EQ(first.scans.size(), 2u);
  ASSERT_EQ(first.odometry.size(), 2u) << "that of the actions, which came first";
  EXPECT_NEAR(first.odometry[1].odom_from_robot.x, 2, 1e-9);
  const Content chosen = read({.lidar_label = "REAR", .odometry_label = "WHEELS"});
  ASSERT_EQ(chosen.scans.size(), 1u);
  EXPECT_EQ(chosen.scans[0].sensor_label, "REAR");
  ASSERT_EQ(chosen.odometry.size(), 1u);
  EXPECT_DOUBLE_EQ(chosen.odometry[0].odom_from_robot.x, 9);
  EXPECT_EQ(chosen.statistics.skipped.at("CActionCollection: another sensor was chosen"), 2);
}

TEST_F(SensorChoiceTest, UnknownLabelsAreRefusedAtOnce) {
  writeTwoOfEach();
  EXPECT_THAT(refusal({.lidar_label = "REAL"}),
              AllOf(HasSubstr("x.rawlog"), HasSubstr("no lidar 'REAL'"), HasSubstr("did you mean 'REAR'"),
                    HasSubstr("there is: 'FRONT', 'REAR'")));
  EXPECT_THAT(refusal({.rgbd_label = "FRONT"}), HasSubstr("there is: 'LEFT', 'RIGHT'"));
  EXPECT_THAT(refusal({.odometry_label = "X"}), HasSubstr("there is: 'WHEELS', 'VISUAL'"));
  EXPECT_THAT(refusal({.sensor_poses = {{"WHEELS", Pose3::Identity()}}}),
              AllOf(HasSubstr("no camera or lidar 'WHEELS'"),
                    HasSubstr("there is: 'FRONT', 'REAR', 'LEFT', 'RIGHT'")));
  writeRawlog(file, {odometryOf("WHEELS", 1, 0)});
  EXPECT_THAT(refusal({.lidar_label = "LASER"}), HasSubstr("there is: none"));
}

TEST_F(SensorChoiceTest, PosesTakeThePlaceOfTheRecordedOnes) {
  writeTwoOfEach();
  const SensorPoses poses =
      parseSensorPoses("FRONT=0.2,0,0.3,90,0,0, LEFT=0.1, -0.05, 1.2, 0, 20, 0", "test");
  const Content content = read({.sensor_poses = poses});
  const Pose3 lidar = content.scans.at(0).robot_from_lidar;
  EXPECT_TRUE(lidar.isApprox(poseFromYpr(0.2, 0, 0.3, M_PI / 2, 0, 0), 1e-9));
  // The image's depth and colour are one camera, so the optical frame sits where the pose says: 20 deg down.
  Pose3 forward_from_optical = Pose3::Identity();
  forward_from_optical.linear() = bodyFromOptical();
  const auto recorded = makeImages(0)->relativePoseIntensityWRTDepth;
  const Pose3 expected = poseFromYpr(0.1, -0.05, 1.2, 0, M_PI / 9, 0) * toPose3(recorded);
  EXPECT_TRUE(content.frames.at(0).robot_from_camera.isApprox(expected, 1e-6));
  const Content before = read();
  EXPECT_FALSE(before.frames.at(0).robot_from_camera.isApprox(expected, 1e-6));
}

TEST(SensorPoses, TextToPose) {
  const Pose3 pose = parsePose("1,-2,0.5,90,10,-5", "test");
  EXPECT_TRUE(pose.isApprox(poseFromYpr(1, -2, 0.5, M_PI / 2, M_PI / 18, -M_PI / 36), 1e-12));
  EXPECT_EQ(formatPose(pose), "1,-2,0.5,90,10,-5");
  EXPECT_EQ(formatPose(Pose3::Identity()), "0,0,0,0,0,0");
  const auto poses = parseSensorPoses("A b=1,0,0,0,0,0,=2,0,0,0,0,0, A b = 3,0,0,0,0,0", "test");
  ASSERT_EQ(poses.size(), 2u) << "of two for one label the last one counts; a label may be empty";
  EXPECT_DOUBLE_EQ(poses.at("A b").translation().x(), 3);
  EXPECT_DOUBLE_EQ(poses.at("").translation().x(), 2);
  EXPECT_TRUE(parseSensorPoses("", "test").empty());
}

TEST(SensorPoses, TextThatIsNoPose) {
  const auto refusalOf = [](const std::string& text) {
    return messageOf<ConfigError>([&] { parseSensorPoses(text, "--pose"); });
  };
  EXPECT_THAT(refusalOf("LASER=1,2,3,4,5"), AllOf(HasSubstr("'LASER'"), HasSubstr("5 numbers instead of 6"),
                                                  HasSubstr("x,y,z,yaw,pitch,roll in metres and degrees")));
  EXPECT_THAT(refusalOf("LASER=1,2,3,4,5,6,7"), HasSubstr("7 numbers"));
  EXPECT_THAT(refusalOf("LASER=1,2,3,4,5,"), HasSubstr("'' is not a number"));
  EXPECT_THAT(refusalOf("LASER=1,2,3,4,5,nan"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(refusalOf("LASER=1,2,inf,4,5,6"), HasSubstr("'inf' is not a number"));
  EXPECT_THAT(refusalOf("LASER=1,2,3m,4,5,6"), HasSubstr("'3m' is not a number"));
  EXPECT_THAT(refusalOf("LASER=1e5,0,0,0,0,0"), HasSubstr("1 km"));
  EXPECT_THAT(refusalOf("1,2,3,4,5,6"), HasSubstr("names no sensor"));
}

}  // namespace
}  // namespace roomgraph
