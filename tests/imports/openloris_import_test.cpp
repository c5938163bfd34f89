// SPDX-License-Identifier: BSD-3-Clause
// Folders in the layout of OpenLORIS-Scene, which we wrote ourselves: the records of the rawlog, every fault
// in a line.
#include <gmock/gmock.h>

#include "errors_of.h"
#include "openloris_maker.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

/// A sequence of the first seconds of the tiny room, in which a test may change something before the import.
struct Sequence {
  explicit Sequence(double odometry_offset_s = 0) {
    for (auto& record : recordsIn(kTinyRoom))
      if (secondsOf(*record) < 1700000001.95) room.push_back(record);
    place = writeSequence(folder, room, odometry_offset_s);
  }
  void import(const OpenlorisImportOptions& options = {}) {
    result = importOpenloris(place, folder.file("x.rawlog"), options);
    records = recordsIn(folder.file("x.rawlog"));
  }
  std::vector<std::shared_ptr<CObservation3DRangeScan>> images() const {
    return only<CObservation3DRangeScan>(records);
  }

  TemporaryFolder folder;
  std::vector<mrpt::obs::CObservation::Ptr> room, records;
  std::filesystem::path place;
  OpenlorisImportResult result;
};

TEST(OpenlorisImport, SequenceOfARawlogGivesItsRecords) {
  Sequence sequence;
  sequence.import();
  EXPECT_THAT(sequence.result.warnings, IsEmpty());
  EXPECT_THAT(sequence.result.skipped, IsEmpty());
  const auto wanted = only<CObservation3DRangeScan>(sequence.room), images = sequence.images();
  ASSERT_EQ(wanted.size(), 10u);
  ASSERT_EQ(images.size(), wanted.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_NEAR(secondsOf(*images[i]), secondsOf(*wanted[i]), 2e-6) << "the time of colour";
    EXPECT_EQ(cv::norm(images[i]->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY),
                       wanted[i]->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY)),
              0);
    EXPECT_TRUE(images[i]->rangeImage == wanted[i]->rangeImage);
    EXPECT_FLOAT_EQ(images[i]->rangeUnits, 0.001f);
    EXPECT_DOUBLE_EQ(images[i]->cameraParams.fx(), wanted[i]->cameraParams.fx());
    EXPECT_DOUBLE_EQ(images[i]->cameraParams.cy(), wanted[i]->cameraParams.cy());
    EXPECT_TRUE(ObservationReader::isRegistered(*images[i]));
    EXPECT_TRUE(toPose3(images[i]->sensorPose).isApprox(toPose3(wanted[i]->sensorPose), 1e-9));
  }
  const auto wheels = only<CObservationOdometry>(sequence.records),
             wanted_wheels = only<CObservationOdometry>(sequence.room);
  ASSERT_EQ(wheels.size(), wanted_wheels.size());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    EXPECT_NEAR(wheels[i]->odometry.x(), wanted_wheels[i]->odometry.x(), 1e-8);
    EXPECT_NEAR(wheels[i]->odometry.phi(), wanted_wheels[i]->odometry.phi(), 1e-8);
    EXPECT_NEAR(wheels[i]->velocityLocal.omega, wanted_wheels[i]->velocityLocal.omega, 1e-6);
  }
  for (std::size_t i = 1; i < sequence.records.size(); ++i)
    EXPECT_LE(secondsOf(*sequence.records[i - 1]), secondsOf(*sequence.records[i]));
  EXPECT_THAT(sequence.folder.read("x.groundtruth.txt"), HasSubstr("1700000000.000000 "));
}

TEST(OpenlorisImport, MissingCalibrationCostsTheImagesOnly) {
  Sequence sequence;
  std::filesystem::remove(sequence.place / "sensors.yaml");
  sequence.import();
  EXPECT_THAT(sequence.result.warnings,
              ElementsAre("images are left out: no sensors.yaml (--camera FX,FY,CX,CY gives it)"));
  EXPECT_THAT(sequence.images(), IsEmpty());
  EXPECT_THAT(only<CObservationOdometry>(sequence.records), testing::SizeIs(20));
  sequence.import({.camera = PinholeCamera{0, 0, 300, 301, 150, 110, {}}});
  ASSERT_EQ(sequence.images().size(), 10u);
  EXPECT_DOUBLE_EQ(sequence.images()[0]->cameraParams.fy(), 301);
}

TEST(OpenlorisImport, CalibrationThatCannotBeIsTold) {
  Sequence sequence;
  const auto warning = [&](const std::string& yaml) {
    sequence.folder.write("room1-1/sensors.yaml", yaml);
    sequence.import();
    EXPECT_THAT(sequence.images(), IsEmpty());
    return sequence.result.warnings.at(0);
  };
  EXPECT_THAT(warning("%YAML:1.0\n---\nd400_color_optical_frame: [1, 2"),
              HasSubstr("sensors.yaml: is no YAML of OpenCV"));
  EXPECT_THAT(warning("%YAML:1.0\n---\nt265: 1\n"), HasSubstr("sensors.yaml: no d400_color_optical_frame"));
  EXPECT_THAT(warning(sensorsYaml(320, 240, 0, 159, 119)), HasSubstr("is not calibrated"));
  EXPECT_THAT(warning(sensorsYaml(320, 240, 262, 159, 119, "Kannala-Brandt", 0.1)),
              HasSubstr("distortion model 'Kannala-Brandt' is not known"));
  sequence.folder.write("room1-1/sensors.yaml",
                        sensorsYaml(320, 240, 262, 159, 119, "radial-tangential", 0.1));
  sequence.import();
  EXPECT_DOUBLE_EQ(sequence.images().at(0)->cameraParams.k1(), 0.1);
}

TEST(OpenlorisImport, WithoutTransformsTheCameraIsAtTheRobot) {
  Sequence sequence;
  const auto imported = [&](const std::string& yaml) {
    sequence.folder.write("room1-1/trans_matrix.yaml", yaml);
    sequence.import();
    EXPECT_TRUE(toPose3(sequence.images().at(0)->sensorPose).isApprox(Pose3::Identity(), 1e-9));
    return sequence.result.warnings.at(0);
  };
  const auto at_robot = HasSubstr("the camera is taken to be at the robot's origin");
  EXPECT_THAT(imported("%YAML:1.0\n---\ntrans_matrix:\n" +
                       yamlTransform("world", "d400_color_optical_frame", Pose3::Identity())),
              testing::AllOf(HasSubstr("no transform from base_link to d400_color_optical_frame"), at_robot));
  Pose3 twice = Pose3::Identity();
  twice.linear() *= 2;
  EXPECT_THAT(imported("%YAML:1.0\n---\ntrans_matrix:\n" +
                       yamlTransform("base_link", "d400_color_optical_frame", twice)),
              testing::AllOf(HasSubstr("is no transform"), at_robot));
  EXPECT_THAT(imported("%YAML:1.0\n---\ntrans_matrix:\n" +
                       yamlTransform("a", "d400_color_optical_frame", Pose3::Identity()) +
                       yamlTransform("d400_color_optical_frame", "a", Pose3::Identity())),
              HasSubstr("no transform from base_link"))
      << "a circle";
  std::filesystem::remove(sequence.place / "trans_matrix.yaml");
  sequence.import({.sensor_poses = {{"D400", poseFromYpr(0.1, 0, 0.9, 0, 0, 0)}}});
  EXPECT_THAT(sequence.result.warnings, IsEmpty());
  EXPECT_NEAR(sequence.images()[0]->sensorPose.z(), 0.9, 1e-9);
}

TEST(OpenlorisImport, ClocksThatDisagreeAreTold) {
  Sequence sequence(100);
  sequence.import();
  EXPECT_THAT(sequence.result.warnings, ElementsAre(HasSubstr("odom.txt: is from t = 1700000100.000 to")));
  EXPECT_THAT(sequence.result.warnings, ElementsAre(HasSubstr("their clocks disagree")));
  EXPECT_EQ(sequence.images().size(), 10u);
}

TEST(OpenlorisImport, BrokenPartsCostThemselvesOnly) {
  Sequence sequence;
  std::string depth = sequence.folder.read("room1-1/aligned_depth.txt");
  sequence.folder.write("room1-1/aligned_depth.txt",
                        depth.substr(0, depth.rfind('\n', depth.size() - 2) + 1));  // without the last
  const auto color_files = [&](int i) {
    std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(sequence.place / "color"),
                                             {});
    std::sort(files.begin(), files.end());
    return files.at(static_cast<std::size_t>(i));
  };
  std::filesystem::resize_file(color_files(0), 60);
  std::filesystem::remove(color_files(1));  // so that the third is the second from now on
  cv::imwrite(color_files(1).string(), cv::Mat(24, 32, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto odometry = sequence.folder.read("room1-1/odom.txt");
  sequence.folder.write(
      "room1-1/odom.txt",
      odometry +
          "1700000002 1 2 x\n1700000003 1 2 0 0 0 0 1 0 0 0 0 0 0\n1700000003 1 2 0 0 0 0 1 0 0 0 0 0 0\n"
          "1700000004 1 2 0 0 0 0 0 0 0 0 0 0 0\n-1 1 2 0 0 0 0 1 0 0 0 0 0 0\n");
  sequence.import();
  EXPECT_THAT(sequence.result.skipped,
              Contains(Pair("color: compressed image is damaged, or neither JPEG nor PNG", 1)));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("color: no such file", 1)));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("color.txt: no depth image of its time", 1)));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("odom.txt: same time as the one before", 1)));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("odom.txt: quaternion is not of length 1", 1)));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("odom.txt: time is not between 1970 and 2200", 1)));
  EXPECT_THAT(sequence.result.warnings,
              Contains("odom.txt: 1 lines left out: not understood; first: line 22"));
  EXPECT_THAT(sequence.result.skipped, Contains(Pair("images: not of the camera's size", 1)));
  EXPECT_EQ(sequence.images().size(), 6u);
}

TEST(OpenlorisImport, WhatIsMissingIsTold) {
  Sequence sequence;
  std::filesystem::remove(sequence.place / "odom.txt");
  std::filesystem::remove(sequence.place / "groundtruth.txt");
  sequence.import();
  EXPECT_THAT(sequence.result.warnings, ElementsAre("no odom.txt: no odometry"));
  EXPECT_EQ(sequence.result.ground_truth, "");
  std::filesystem::remove(sequence.place / "aligned_depth.txt");
  EXPECT_THAT(messageOf<InputError>([&] { sequence.import(); }),
              HasSubstr("nothing in it can be imported; images are left out: no aligned_depth.txt"));
  EXPECT_THAT(messageOf<InputError>(
                  [&] { importOpenloris(sequence.folder.file("no"), sequence.folder.file("y.rawlog")); }),
              HasSubstr("no such folder"));
  EXPECT_THAT(messageOf<ConfigError>([&] {
                sequence.import({.sensor_poses = {{"T265", {}}}});
              }),
              HasSubstr("the sensor is D400"));
}

TEST(OpenlorisImport, ImagesOutsideAreTheSame) {
  Sequence inside, outside;
  inside.import();
  outside.import({.external_images = true});
  auto images = outside.images();
  ASSERT_EQ(images.size(), 10u);
  ObservationReader reader(outside.folder.file("x.rawlog")), other(inside.folder.file("x.rawlog"));
  const auto frame = reader.frameOf(*images[3]), wanted = other.frameOf(*inside.images()[3]);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_EQ(cv::norm(frame->color, wanted->color), 0);
  EXPECT_EQ(cv::norm(frame->depth, wanted->depth), 0);
}

}  // namespace
}  // namespace roomgraph
