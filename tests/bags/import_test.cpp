// SPDX-License-Identifier: BSD-3-Clause
// Bags written by Debian's rosbag and by the layout of ROS 2: every record as it was meant.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "bag_maker.h"
#include "errors_of.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

constexpr int kFrames = 20;

void expectPose(const mrpt::poses::CPose3D& pose, double x, double y, double z, double yaw, double pitch) {
  EXPECT_NEAR(pose.x(), x, 1e-9);
  EXPECT_NEAR(pose.y(), y, 1e-9);
  EXPECT_NEAR(pose.z(), z, 1e-9);
  EXPECT_NEAR(pose.yaw(), yaw, 1e-6);
  EXPECT_NEAR(pose.pitch(), pitch, 1e-6);
  EXPECT_NEAR(pose.roll(), 0, 1e-6);
}

// bag_content.py: colour (200, 100 + u, 20 + v), depth 1000 + 10 u + k mm and none at (0, 0).
void expectImages(CObservation3DRangeScan& images, int k, double depth_tolerance_m) {
  EXPECT_EQ(images.sensorLabel, "camera_rgb");
  EXPECT_NEAR(secondsOf(images), kStart_s + 0.1 * k, 1e-6);
  ASSERT_TRUE(images.hasIntensityImage);
  ASSERT_TRUE(images.hasRangeImage);
  const cv::Mat color = images.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
  ASSERT_EQ(color.size(), cv::Size(16, 12));
  EXPECT_EQ(color.at<cv::Vec3b>(5, 9), cv::Vec3b(25, 109, 200));
  ASSERT_EQ(images.rangeImage.rows(), 12);
  ASSERT_EQ(images.rangeImage.cols(), 16);
  EXPECT_EQ(images.rangeImage(0, 0), 0);
  EXPECT_NEAR(images.rangeImage(5, 9) * images.rangeUnits, 1.09 + 0.001 * k, depth_tolerance_m);
  EXPECT_DOUBLE_EQ(images.cameraParamsIntensity.fx(), 20);
  EXPECT_DOUBLE_EQ(images.cameraParamsIntensity.cy(), 5.5);
  EXPECT_TRUE(images.range_is_depth);
  EXPECT_TRUE(ObservationReader::isRegistered(images));
  expectPose(images.sensorPose, 0.2, 0, 0.8, 0, 0);
}

void expectScan(const CObservation2DRangeScan& scan, int k) {
  EXPECT_EQ(scan.sensorLabel, "laser");
  EXPECT_NEAR(secondsOf(scan), kStart_s + 0.1 * k + 0.008, 1e-6) << "the middle of nine beams of 2 ms";
  EXPECT_NEAR(scan.aperture, 2, 1e-6);
  EXPECT_TRUE(scan.rightToLeft);
  EXPECT_FLOAT_EQ(scan.maxRange, 8);
  expectPose(scan.sensorPose, 0.1, 0, 0.25, std::numbers::pi / 2 + 0.5, 0);
  ASSERT_EQ(scan.getScanSize(), 9u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_FALSE(scan.getScanRangeValidity(i)) << "infinite, too near, too far";
  for (std::size_t i = 3; i < 9; ++i) {
    EXPECT_TRUE(scan.getScanRangeValidity(i));
    EXPECT_NEAR(scan.getScanRange(i), 1 + 0.1 * static_cast<double>(i), 1e-6);
  }
  ASSERT_TRUE(scan.hasIntensity());
  EXPECT_EQ(scan.getScanIntensity(4), 40);
}

void expectAll(const Imported& bag, double depth_tolerance_m = 1e-6) {
  const auto images = only<CObservation3DRangeScan>(bag.records);
  const auto scans = only<CObservation2DRangeScan>(bag.records);
  const auto wheels = only<CObservationOdometry>(bag.records);
  const auto imus = only<CObservationIMU>(bag.records);
  ASSERT_EQ(images.size(), kFrames);
  ASSERT_EQ(scans.size(), kFrames);
  ASSERT_EQ(wheels.size(), kFrames);
  ASSERT_EQ(imus.size(), kFrames);
  for (int k = 0; k < kFrames; ++k) {
    const auto i = static_cast<std::size_t>(k);
    expectImages(*images[i], k, depth_tolerance_m);
    expectScan(*scans[i], k);
    EXPECT_EQ(wheels[i]->sensorLabel, "ODOMETRY");
    EXPECT_NEAR(wheels[i]->odometry.x(), 0.05 * k, 1e-9);
    EXPECT_DOUBLE_EQ(wheels[i]->velocityLocal.vx, 0.5);
    EXPECT_FALSE(imus[i]->has(mrpt::obs::IMU_ORI_QUAT_X));
    EXPECT_DOUBLE_EQ(imus[i]->get(mrpt::obs::IMU_WX), 0.1);
    EXPECT_DOUBLE_EQ(imus[i]->get(mrpt::obs::IMU_WZ), 0.3);
    EXPECT_DOUBLE_EQ(imus[i]->get(mrpt::obs::IMU_Z_ACC), 9.8);
    expectPose(imus[i]->sensorPose, 0, 0, 0.1, 0, 0);
  }
  for (std::size_t i = 1; i < bag.records.size(); ++i)
    EXPECT_LE(secondsOf(*bag.records[i - 1]), secondsOf(*bag.records[i])) << i;
}

class EveryStorage : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryStorage, GivesTheSameRecords) {
  const Imported bag(GetParam());
  EXPECT_THAT(bag.result.warnings, IsEmpty());
  EXPECT_THAT(bag.result.skipped, IsEmpty());
  EXPECT_EQ(bag.result.base_frame, "base_footprint");
  expectAll(bag);
}

TEST_P(EveryStorage, GivesTheGroundTruthOfTf) {
  const Imported bag(GetParam());
  EXPECT_EQ(bag.result.truth, "tf mocap -> base_footprint");
  std::istringstream truth(bag.folder.read("x.groundtruth.txt"));
  std::string comment;
  std::getline(truth, comment);
  EXPECT_EQ(comment, "# poses of the robot");
  for (int k = 0; k < kFrames; ++k) {
    double t, x, y, z, qx, qy, qz, qw;
    ASSERT_TRUE(truth >> t >> x >> y >> z >> qx >> qy >> qz >> qw) << k;
    EXPECT_NEAR(t, kStart_s + 0.1 * k, 1e-6);
    EXPECT_NEAR(x, 1 + 0.06 * k, 1e-6);
    EXPECT_NEAR(qw, 1, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Bags, EveryStorage,
                         ::testing::Values("{}", R"({"compression": "bz2"})", R"({"compression": "lz4"})",
                                           R"({"ros2": "<"})", R"({"ros2": ">"})",
                                           R"({"ros2": "<", "index": false})"));

struct Encoding {
  const char* json;
  double depth_tolerance_m;
};
class EveryEncoding : public ::testing::TestWithParam<Encoding> {};

TEST_P(EveryEncoding, GivesTheSameImages) {
  const Imported bag(GetParam().json);
  EXPECT_THAT(bag.result.warnings, IsEmpty());
  expectAll(bag, GetParam().depth_tolerance_m);
}

// Inverse depth of 5000 steps a metre at 1 m: 1.3 m^2 / 5000 / 2 between two steps.
INSTANTIATE_TEST_SUITE_P(
    Bags, EveryEncoding,
    ::testing::Values(Encoding{R"({"color": "bgr8"})", 1e-6}, Encoding{R"({"color": "rgba8"})", 1e-6},
                      Encoding{R"({"color": "png"})", 1e-6}, Encoding{R"({"depth": "32FC1"})", 1e-6},
                      Encoding{R"({"depth": "32FC1", "big_endian_depth": true})", 1e-6},
                      Encoding{R"({"big_endian_depth": true})", 1e-6},
                      Encoding{R"({"depth": "compressedDepth"})", 1e-6},
                      Encoding{R"({"depth": "rvl"})", 1e-6},
                      Encoding{R"({"depth": "compressedDepth32"})", 3e-4},
                      Encoding{R"({"ros2": "<", "color": "png", "depth": "rvl"})", 1e-6}));

TEST(BagImport, GreyImagesStayGrey) {
  const Imported bag(R"({"color": "mono8"})");
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_EQ(images.size(), kFrames);
  const cv::Mat gray = images[3]->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
  ASSERT_EQ(gray.type(), CV_8UC1);
  EXPECT_EQ(gray.at<std::uint8_t>(5, 9), 109);
}

TEST(BagImport, UnknownEncodingCostsTheImagesOnly) {
  const Imported bag(R"({"color": "martian8"})", {.topics = {"color=/camera/rgb/image_raw"}});
  EXPECT_THAT(bag.result.skipped,
              Contains(Pair("/camera/rgb/image_raw: encoding 'martian8' is not known", kFrames)));
  EXPECT_EQ(only<CObservation2DRangeScan>(bag.records).size(), kFrames);
  EXPECT_THAT(only<CObservation3DRangeScan>(bag.records), IsEmpty());
}

TEST(BagImport, WithoutCameraInfoTheRestIsUsed) {
  const Imported bag(R"({"info": false})");
  EXPECT_THAT(
      bag.result.warnings,
      Contains(HasSubstr("/camera/rgb/image_raw: images are left out: no usable camera_info; --camera")));
  EXPECT_THAT(only<CObservation3DRangeScan>(bag.records), IsEmpty());
  EXPECT_EQ(only<CObservationOdometry>(bag.records).size(), kFrames);
  const Imported given(R"({"info": false})", {.camera = PinholeCamera{0, 0, 20, 20, 7.5, 5.5, {}}});
  expectAll(given);
}

TEST(BagImport, ClocksThatDisagreeAreToldAndCorrected) {
  const char* const late = R"({"scan_offset": -3.2})";
  const Imported bag(late);
  EXPECT_THAT(bag.result.warnings, ElementsAre(HasSubstr("/scan: clock is 3.2")));
  EXPECT_THAT(bag.result.warnings, ElementsAre(HasSubstr("behind those of the other sensors")));
  EXPECT_NEAR(secondsOf(*only<CObservation2DRangeScan>(bag.records)[0]), kStart_s - 3.2 + 0.008, 1e-6);
  const Imported corrected(late, {.times = BagTimes::kCorrected});
  EXPECT_NEAR(secondsOf(*only<CObservation2DRangeScan>(corrected.records)[0]), kStart_s + 0.02 + 0.008, 1e-6);
  EXPECT_EQ(only<CObservation3DRangeScan>(corrected.records).size(), kFrames);
}

TEST(BagImport, MessagesWithoutTimesGetThatOfReception) {
  const Imported bag(R"({"stamps": false})", {.max_time_difference_s = 0.02});
  EXPECT_THAT(bag.result.warnings,
              Contains(HasSubstr("/odom: 20 of 20 messages have no time in their header")));
  EXPECT_NEAR(secondsOf(*only<CObservationOdometry>(bag.records)[1]), kStart_s + 0.1, 1e-6);
  EXPECT_EQ(only<CObservation3DRangeScan>(bag.records).size(), kFrames) << "received 10 ms apart";
}

TEST(BagImport, ColourAndDepthArePairedByTime) {
  const Imported near(R"({"depth_delay": 0.015})");
  EXPECT_EQ(only<CObservation3DRangeScan>(near.records).size(), kFrames);
  EXPECT_NEAR(secondsOf(*only<CObservation3DRangeScan>(near.records)[1]), kStart_s + 0.1, 1e-6)
      << "the time of colour";
  const Imported far(R"({"depth_delay": 0.03})");
  EXPECT_THAT(only<CObservation3DRangeScan>(far.records), IsEmpty());
  EXPECT_THAT(far.result.skipped, Contains(Pair("camera_rgb: no depth image of its time", kFrames)));
  EXPECT_THAT(far.result.skipped,
              Contains(Pair("/camera/depth/image_raw: no colour image of its time", kFrames)));
}

TEST(BagImport, JointsThatMoveAreLookedUpAtEachTime) {
  const Imported bag(R"({"extrinsics": "moving"})");
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_EQ(images.size(), kFrames);
  expectPose(images[4]->sensorPose, 0.2, 0, 0.8, 0, 0);
  expectPose(images[15]->sensorPose, 0.2, 0, 0.8, 0, 10 * std::numbers::pi / 180);
}

TEST(BagImport, DepthBesideColourIsProjectedByTf) {
  const Imported bag(R"({"depth_frame": "camera_depth_optical_frame"})");
  EXPECT_THAT(bag.result.warnings, ElementsAre(HasSubstr("registration: depth is not registered to colour")));
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_EQ(images.size(), kFrames);
  EXPECT_FALSE(ObservationReader::isRegistered(*images[0]));
  expectPose(images[0]->sensorPose, 0.2, 0.025, 0.8, 0, 0);
  ObservationReader reader(bag.folder.file("x.rawlog"));
  const auto frame = reader.frameOf(*images[0]);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_NEAR(frame->robot_from_camera.translation().y(), 0, 1e-9) << "the colour camera";
  EXPECT_TRUE(frame->robot_from_camera.linear().isApprox(bodyFromOptical(), 1e-9));
}

TEST(BagImport, OtherIntrinsicsInOneFrameAreTold) {
  const Imported bag(R"({"depth_focal": 24.0})");
  EXPECT_THAT(
      bag.result.warnings,
      ElementsAre(HasSubstr("registration: depth has the frame of the colour image but another camera")));
  EXPECT_FALSE(ObservationReader::isRegistered(*only<CObservation3DRangeScan>(bag.records)[0]));
}

TEST(BagImport, DistortionStaysWithTheCameraOrIsRemoved) {
  const Imported kept(R"({"distortion": [0.1, -0.05, 0.001, 0.002, 0.01]})");
  const auto& camera = only<CObservation3DRangeScan>(kept.records)[0]->cameraParamsIntensity;
  EXPECT_DOUBLE_EQ(camera.k1(), 0.1);
  EXPECT_DOUBLE_EQ(camera.p2(), 0.002);
  const Imported removed(R"({"model": "rational_polynomial", "distortion": [0.1, 0, 0, 0, 0, 0.1, 0, 0]})");
  const auto& images = *only<CObservation3DRangeScan>(removed.records)[0];
  EXPECT_DOUBLE_EQ(images.cameraParamsIntensity.k1(), 0);
  EXPECT_EQ(images.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY).at<cv::Vec3b>(5, 9),
            cv::Vec3b(25, 109, 200))
      << "k1 and k4 are the same: nothing moves";
  const Imported odd(R"({"model": "kaleidoscope", "distortion": [0.1, 0, 0, 0, 0]})");
  EXPECT_THAT(odd.result.warnings, Contains(HasSubstr("distortion model 'kaleidoscope' is not known")));
}

TEST(BagImport, WithoutTransformsSensorsAreAtTheRobot) {
  const Imported bag(R"({"tf": false})", {.sensor_poses = {{"laser", poseFromYpr(1, 2, 3, 0, 0, 0)}}});
  EXPECT_THAT(bag.result.warnings,
              Contains(HasSubstr("frame 'camera_rgb_optical_frame': no transform to 'base_footprint'")));
  expectPose(only<CObservation3DRangeScan>(bag.records)[0]->sensorPose, 0, 0, 0, 0, 0);
  expectPose(only<CObservation2DRangeScan>(bag.records)[0]->sensorPose, 1, 2, 3, 0, 0);
}

TEST(BagImport, OdometryComesFromTfWhenNoTopicHasIt) {
  const Imported bag(R"({"odometry": false})");
  const auto wheels = only<CObservationOdometry>(bag.records);
  ASSERT_EQ(wheels.size(), kFrames);
  EXPECT_NEAR(wheels[7]->odometry.x(), 0.35, 1e-9);
  EXPECT_THAT(bag.result.used, Contains("odometry: tf odom -> base_footprint"));
}

TEST(BagImport, GroundTruthOfATopicAndNone) {
  const Imported topic(R"({"truth": "topic"})");
  EXPECT_EQ(topic.result.truth, "/mocap/robot/pose");
  EXPECT_THAT(topic.folder.read("x.groundtruth.txt"), HasSubstr("1700000001.000000000 1.5 0 0 0 0 0 1\n"));
  const Imported none("{}", {.truth = "none"});
  EXPECT_FALSE(std::filesystem::exists(none.folder.file("x.groundtruth.txt")));
  EXPECT_THAT(Imported(R"({"truth": ""})").result.truth, IsEmpty()) << "odometry is none";
}

TEST(BagImport, TopicsAreChosenByName) {
  const Imported bag("{}", {.topics = {"imu=none", "color=none", "/scan"}});
  EXPECT_THAT(bag.result.written, Contains(Key("laser")));
  EXPECT_THAT(only<CObservationIMU>(bag.records), IsEmpty());
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_EQ(images.size(), kFrames);
  EXPECT_FALSE(images[0]->hasIntensityImage);
  expectPose(images[0]->sensorPose, 0.2, 0, 0.8, 0, 0);
  const TemporaryFolder folder;
  const auto bag_file = makeBag(folder);
  const auto error = [&](const BagImportOptions& options) {
    return messageOf<ConfigError>([&] { importBag(bag_file, folder.file("y.rawlog"), options); });
  };
  EXPECT_THAT(error({.topics = {"/scam"}}), HasSubstr("no such topic in the bag (did you mean '/scan'?)"));
  EXPECT_THAT(error({.topics = {"colour=/scan"}}), HasSubstr("no kind 'colour' (did you mean 'color'?)"));
  EXPECT_THAT(error({.topics = {"color=/scan"}}),
              HasSubstr("a topic of type sensor_msgs/LaserScan cannot be imported as color"));
  EXPECT_THAT(error({.base_frame = "base_lnk"}),
              HasSubstr("--base base_lnk: tf has no such frame (did you mean 'base_link'?)"));
  EXPECT_THAT(error({.truth = "/scan"}), HasSubstr("--truth /scan: is of type sensor_msgs/LaserScan"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.rawlog")));
}

TEST(BagImport, ExternalImagesAreWithoutLoss) {
  const Imported bag("{}", {.external_images = true});
  EXPECT_TRUE(std::filesystem::exists(bag.folder.file("x_Images/camera_rgb_1700000000.000000_rgb.png")));
  expectAll(bag);
}

TEST(BagImport, ListTellsTopicsFramesAndClocks) {
  const TemporaryFolder folder;
  const auto contents = listBag(makeBag(folder, R"({"scan_offset": -1.5})"));
  const auto scan = std::find_if(contents.topics.begin(), contents.topics.end(),
                                 [](const auto& topic) { return topic.name == "/scan"; });
  ASSERT_NE(scan, contents.topics.end());
  EXPECT_EQ(scan->count, 20u);
  EXPECT_EQ(scan->used_as, "scan");
  EXPECT_NEAR(*scan->header_minus_received_s, -1.52, 1e-6);
  EXPECT_THAT(contents.frames, Contains("laser_link"));
  EXPECT_THAT(contents.frames, Not(Contains("/camera_link"))) << "old names lose their slash";
}

}  // namespace
}  // namespace roomgraph
