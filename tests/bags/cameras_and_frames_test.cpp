// SPDX-License-Identifier: BSD-3-Clause
// Bags whose images are not as their camera_info says, and whose odometry is not the robot's.
#include <gmock/gmock.h>

#include "bag_maker.h"
#include "camera_model.h"
#include "record_making.h"

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
using ::testing::SizeIs;

constexpr std::size_t kAllFrames = 20;

TEST(ImportedCamera, WithoutASizeHasThatOfTheImages) {
  const BagImportOptions options{.camera = PinholeCamera{0, 0, 20, 20, 7.5, 5.5, {}}};
  for (const char* json : {R"({"info": false, "color": "png", "depth": "compressedDepth"})",
                           R"({"info": false, "color": "png", "depth": "rvl"})"}) {
    const Imported bag(json, options);
    const auto images = only<CObservation3DRangeScan>(bag.records);
    ASSERT_THAT(images, SizeIs(kAllFrames));
    for (const auto& camera : {images[0]->cameraParamsIntensity, images[0]->cameraParams}) {
      EXPECT_EQ(camera.ncols, 16u);
      EXPECT_EQ(camera.nrows, 12u);
    }
    EXPECT_THAT(bag.result.warnings, IsEmpty());
    EXPECT_TRUE(ObservationReader::isRegistered(*images[0]));
  }
}

TEST(ImportedCamera, IsScaledToSmallerImages) {
  const Imported bag(
      R"({"info_change": {"width": 32, "height": 24, "K": [40, 0, 15.5, 0, 40, 11.5, 0, 0, 1]}})");
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_THAT(images, SizeIs(kAllFrames));
  for (const auto& camera : {images[0]->cameraParamsIntensity, images[0]->cameraParams}) {
    EXPECT_EQ(camera.ncols, 16u);
    EXPECT_DOUBLE_EQ(camera.fx(), 20);
    EXPECT_DOUBLE_EQ(camera.cx(), 7.5);
    EXPECT_DOUBLE_EQ(camera.cy(), 5.5);
  }
  EXPECT_THAT(bag.result.warnings,
              ElementsAre(HasSubstr("/camera/rgb/image_raw are of another size: it is scaled by 0.5"),
                          HasSubstr("/camera/depth/image_raw are of another size: it is scaled by 0.5")));
}

TEST(ImportedCamera, ThatIsGivenIsOfTheColourAndScaledToTheDepth) {
  for (const char* json :
       {R"({"info": false, "depth_every": 2})", R"({"info": false, "depth_every": 2, "color": "png"})"}) {
    const Imported bag(json, {.camera = PinholeCamera{0, 0, 20, 20, 7.5, 5.5, {}}});
    const auto images = only<CObservation3DRangeScan>(bag.records);
    ASSERT_THAT(images, SizeIs(kAllFrames));
    EXPECT_DOUBLE_EQ(images[0]->cameraParamsIntensity.fx(), 20);
    EXPECT_DOUBLE_EQ(images[0]->cameraParams.fx(), 10);
    EXPECT_EQ(images[0]->cameraParams.ncols, 8u);
    EXPECT_THAT(
        bag.result.warnings,
        ElementsAre(HasSubstr("--camera: the images of /camera/depth/image_raw are of another size")));
  }
}

TEST(ImportedCamera, IsNotThatOfASingleImageOfAnotherSize) {
  const Imported bag(R"({"small_depth_at": 5})");
  EXPECT_THAT(only<CObservation3DRangeScan>(bag.records), SizeIs(kAllFrames - 1));
  EXPECT_THAT(bag.result.skipped,
              Contains(Pair("/camera/depth/image_raw: image of 8x6 px, the camera is of 16x12", 1)));
}

TEST(ImportedCamera, OfAnotherShapeLeavesTheImagesOut) {
  const Imported bag(R"({"info_change": {"width": 32, "height": 32}})");
  EXPECT_THAT(only<CObservation3DRangeScan>(bag.records), IsEmpty());
  EXPECT_THAT(bag.result.warnings,
              Contains(HasSubstr("/camera/rgb/camera_info: is of 32x32 px, the images of 16x12 px")));
  EXPECT_THAT(bag.result.warnings, Contains(HasSubstr("/camera/rgb/image_raw: images are left out")));
  EXPECT_THAT(only<CObservationOdometry>(bag.records), SizeIs(kAllFrames));
}

TEST(ImportedCamera, RegionOfInterestMovesTheCentre) {
  const Imported bag(
      R"({"info_change": {"width": 64, "height": 48, "K": [20, 0, 27.5, 0, 20, 15.5, 0, 0, 1],
          "roi": {"x_offset": 20, "y_offset": 10, "width": 16, "height": 12, "do_rectify": false}}})");
  const auto images = only<CObservation3DRangeScan>(bag.records);
  ASSERT_THAT(images, SizeIs(kAllFrames));
  EXPECT_DOUBLE_EQ(images[0]->cameraParams.fx(), 20);
  EXPECT_DOUBLE_EQ(images[0]->cameraParams.cx(), 7.5);
  EXPECT_DOUBLE_EQ(images[0]->cameraParams.cy(), 5.5);
  EXPECT_THAT(bag.result.warnings, IsEmpty());
}

bags::CameraInfoMessage infoOfARegion() {
  bags::CameraInfoMessage info;
  info.width = 640;
  info.height = 480;
  info.k = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.roi_x = 160;
  info.roi_y = 120;
  info.roi_width = 320;
  info.roi_height = 240;
  return info;
}

TEST(CameraOfARegion, IsBinnedAndOnlyWhereTheImagesShowIt) {
  auto info = infoOfARegion();
  const PinholeCamera region{320, 240, 500, 510, 160, 120, {}};
  EXPECT_EQ(bags::cameraModel(info, false).camera, region);
  EXPECT_EQ(bags::cameraModel(info, false, {320, 240}).camera, region);
  EXPECT_EQ(bags::cameraModel(info, false, {640, 480}).camera,
            (PinholeCamera{640, 480, 500, 510, 320, 240, {}}));
  EXPECT_EQ(bags::cameraModel(info, false, {160, 120}).camera.fx, 125) << "the whole, made smaller";
  info.binning_x = info.binning_y = 2;
  EXPECT_EQ(bags::cameraModel(info, false, {160, 120}).camera,
            (PinholeCamera{160, 120, 250, 255, 80, 60, {}}));
  info.roi_x = 0xffffffff;
  EXPECT_EQ(bags::cameraModel(info, false).camera.width, 320) << "no region of this sensor";
}

TEST(CameraOfARegion, RemovesDistortionFromSmallerImages) {
  auto info = infoOfARegion();
  info.roi_width = info.roi_height = 0;
  info.distortion_model = "equidistant";
  info.distortion = {0.05, 0, 0, 0};
  EXPECT_EQ(bags::cameraModel(info, false, {320, 240}).map_x.size(), cv::Size(320, 240));
}

TEST(OdometryOfAnotherFrame, IsTurnedIntoTheRobots) {
  const Imported bag(R"({"odometry_child": "side", "truth": "odometry"})");
  const auto wheels = only<CObservationOdometry>(bag.records);
  ASSERT_THAT(wheels, SizeIs(kAllFrames));
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    EXPECT_NEAR(wheels[k]->odometry.x(), 0.05 * static_cast<double>(k), 1e-6);
    EXPECT_NEAR(wheels[k]->odometry.phi(), 0, 1e-6);
    EXPECT_NEAR(wheels[k]->velocityLocal.vx, 0.5, 1e-6);
    EXPECT_NEAR(wheels[k]->velocityLocal.vy, 0, 1e-6);
    EXPECT_NEAR(wheels[k]->odometry.y(), 0, 1e-6);
    EXPECT_EQ(wheels[k]->sensorLabel, "ODOMETRY");
  }
  EXPECT_THAT(bag.result.warnings, IsEmpty());
  EXPECT_EQ(bag.result.truth, "/mocap/odom");
  std::istringstream truth(bag.folder.read("x.groundtruth.txt"));
  std::string comment;
  std::getline(truth, comment);
  EXPECT_EQ(comment, "# poses of the robot");
  double t, x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(truth >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_NEAR(x, 1, 1e-6);
  EXPECT_NEAR(z, 0, 1e-6);
  EXPECT_NEAR(std::abs(qw), 1, 1e-6);
}

TEST(OdometryOfAnotherFrame, ThatTfDoesNotKnowIsTold) {
  const Imported bag(R"({"odometry_child": "moon", "truth": "odometry"})");
  EXPECT_THAT(bag.result.warnings,
              Contains(HasSubstr("/odom: odometry is of 'moon', the robot is 'base_footprint'")));
  EXPECT_THAT(bag.result.warnings, Contains(HasSubstr("/mocap/odom: ground truth is of 'moon'")));
  EXPECT_THAT(only<CObservationOdometry>(bag.records), SizeIs(kAllFrames));
  const Imported link(R"({"odometry_child": "base_link"})");
  EXPECT_THAT(link.result.warnings, IsEmpty()) << "only higher";
  EXPECT_NEAR(only<CObservationOdometry>(link.records)[7]->odometry.x(), 0.35, 1e-9);
}

TEST(OdometryOfAnotherFrame, TurningMovesWhatIsBesideTheCentre) {
  bags::OdometryMessage odometry;
  odometry.twist = {1, 0, 0, 0, 0, 0.5};
  const auto moved = bags::movedTo(odometry, poseFromYpr(0.4, 0, 0, std::numbers::pi / 2, 0, 0));
  EXPECT_NEAR(moved.twist[0], 0.2, 1e-12) << "0.5 rad/s at 0.4 m, to the left, which is ahead there";
  EXPECT_NEAR(moved.twist[1], -1, 1e-12);
  EXPECT_NEAR(moved.twist[5], 0.5, 1e-12);
  EXPECT_NEAR(moved.pose.translation().x(), 0.4, 1e-12);
}

TEST(OnlyGroundTruth, IsNoOdometry) {
  const Imported bag(R"({"truth": "odometry", "odometry": false, "tf": false})");
  EXPECT_THAT(only<CObservationOdometry>(bag.records), IsEmpty());
  EXPECT_EQ(bag.result.truth, "/mocap/odom");
  const Imported asked(R"({"truth": "odometry", "odometry": false, "tf": false})",
                       {.topics = {"odometry=/mocap/odom"}});
  EXPECT_THAT(only<CObservationOdometry>(asked.records), SizeIs(kAllFrames)) << "whoever insists";
}

TEST(TransformsOfAMessage, ThatCannotBeUsedCostThemselvesOnly) {
  for (const char* json : {R"({"bad_transform": true})", R"({"bad_transform": true, "ros2": "<"})"}) {
    const Imported bag(json);
    EXPECT_THAT(bag.result.skipped,
                ElementsAre(Pair("/tf_static: base_link -> gps: quaternion is not of length 1", 1)));
    EXPECT_THAT(bag.result.warnings, IsEmpty());
    EXPECT_NEAR(only<CObservation3DRangeScan>(bag.records)[0]->sensorPose.z(), 0.8, 1e-9);
  }
}

}  // namespace
}  // namespace roomgraph
