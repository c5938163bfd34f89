// SPDX-License-Identifier: BSD-3-Clause
// RGB-D record to Frame: colour order, depth along rays, registration, distortion, external images.
#include <gmock/gmock.h>

#include <chrono>
#include <limits>
#include <opencv2/core.hpp>

#include "depth_registration.h"
#include "frame_conversion.h"
#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using testing::ElementsAre;
using testing::Pair;
using testing::StartsWith;

class FrameConversion : public testing::Test {
 protected:
  Frame readBack(const Object& object) {
    writeRawlog(folder_.file("x.rawlog"), {object});
    RawlogReader reader(folder_.file("x.rawlog"));
    auto record = reader.next();
    statistics_ = reader.statistics();
    if (!record) throw std::runtime_error("no frame");
    return std::get<Frame>(*record);
  }
  TemporaryFolder folder_;
  ReadStatistics statistics_;
};

TEST_F(FrameConversion, ColourOrderDepthAndCamera) {
  const auto frame = readBack(makeImages(5));
  ASSERT_EQ(frame.color.type(), CV_8UC3);
  ASSERT_EQ(frame.gray.type(), CV_8UC1);
  ASSERT_EQ(frame.depth.type(), CV_32FC1);
  const auto pixel = frame.color.at<cv::Vec3b>(6, 8);
  EXPECT_NEAR(pixel[0], 20, 6);   // blue
  EXPECT_NEAR(pixel[1], 108, 6);  // green
  EXPECT_NEAR(pixel[2], 200, 6);  // red
  EXPECT_FLOAT_EQ(frame.depth.at<float>(0, 0), 0);
  EXPECT_NEAR(frame.depth.at<float>(3, 7), 1.07, 1e-6);
  EXPECT_EQ(frame.camera.width, 16);
  EXPECT_DOUBLE_EQ(frame.camera.fx, 20);
  // Default sensor pose: the camera looks along the robot's x axis, image right is -y, image down is -z.
  EXPECT_TRUE(frame.robot_from_camera.linear().isApprox(bodyFromOptical(), 1e-9));
}

TEST_F(FrameConversion, SensorPoseIsThatOfTheForwardLookingBody) {
  auto images = makeImages(5);
  images->sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.8, 0, 0.3, 0);  // nose down by 0.3 rad
  const auto frame = readBack(images);
  // One metre ahead on the optical axis: x = 0.1 + cos(0.3), z = 0.8 - sin(0.3).
  const Eigen::Vector3d ahead = frame.robot_from_camera * Eigen::Vector3d(0, 0, 1);
  EXPECT_NEAR(ahead.x(), 0.1 + std::cos(0.3), 1e-9);
  EXPECT_NEAR(ahead.y(), 0.2, 1e-9);
  EXPECT_NEAR(ahead.z(), 0.8 - std::sin(0.3), 1e-9);
}

TEST_F(FrameConversion, RangeAlongTheRayBecomesDepth) {
  auto images = makeImages(5);
  images->range_is_depth = false;
  images->rangeImage.fill(2000);
  const auto frame = readBack(images);
  // K^-1 (15, 0) = ((15 - 7.5) / 20, (0 - 5.5) / 20): the ray's length at z = 1.
  const double length = std::sqrt(1 + 0.375 * 0.375 + 0.275 * 0.275);
  EXPECT_NEAR(frame.depth.at<float>(0, 15), 2 / length, 1e-5);
}

TEST_F(FrameConversion, DepthOfAnotherCameraIsRegistered) {
  auto images = makeImages(5);
  images->rangeImage.fill(2000);
  images->rangeImage(6, 8) = 1000;
  // Colour camera 0.1 m to the right of the depth camera (y = -0.1 in MRPT's axes):
  // a point at 2 m moves left by fx * 0.1 / 2 = 1 px, one at 1 m by 2 px.
  images->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, -0.1, 0, -M_PI / 2, 0, -M_PI / 2);
  const auto frame = readBack(images);
  EXPECT_NEAR(frame.depth.at<float>(6, 6), 1, 1e-5) << "nearer surface wins";
  EXPECT_NEAR(frame.depth.at<float>(6, 5), 2, 1e-5);
  EXPECT_FLOAT_EQ(frame.depth.at<float>(6, 7), 0) << "hidden from the depth camera";
  EXPECT_FLOAT_EQ(frame.depth.at<float>(6, 15), 0) << "outside the depth image";
  EXPECT_NEAR((frame.robot_from_camera.translation() - Eigen::Vector3d(0, -0.1, 0)).norm(), 0, 1e-9);
}

TEST_F(FrameConversion, CoarseDepthFillsAFineColourImage) {
  auto images = makeImages(5, 32, 24);
  images->rangeImage_setSize(12, 16);
  images->rangeImage.fill(1500);
  images->cameraParams.ncols = 16;
  images->cameraParams.nrows = 12;
  images->cameraParams.setIntrinsicParamsFromValues(10, 10, 7.5, 5.5);
  images->cameraParamsIntensity.setIntrinsicParamsFromValues(20, 20, 15.5, 11.5);
  const auto frame = readBack(images);
  ASSERT_EQ(frame.depth.size(), cv::Size(32, 24));
  EXPECT_EQ(cv::countNonZero(frame.depth), 32 * 24);
  EXPECT_NEAR(frame.depth.at<float>(20, 3), 1.5, 1e-5);
}

// Cameras that cannot be: rays without a direction, points at no pixel, pixels that would each cover the whole image.
TEST(DepthRegistration, ImpossibleCamerasLeavePixelsOutAndTakeNoLongerThanOthers) {
  const cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(2));
  const PinholeCamera target{640, 480, 500, 500, 320, 240};
  const float nan = std::numeric_limits<float>::quiet_NaN(), far = 1e30f;
  for (const float u : {nan, far, -far}) {
    const cv::Mat rays(240, 320, CV_32FC2, cv::Scalar(static_cast<double>(u), 0));
    EXPECT_EQ(cv::countNonZero(registerDepth(depth, rays, 500, Pose3::Identity(), target)), 0) << u;
  }
  const cv::Mat ahead(240, 320, CV_32FC2, cv::Scalar(0, 0));
  const auto start = std::chrono::steady_clock::now();
  const cv::Mat out = registerDepth(depth, ahead, 1e-6, Pose3::Identity(), target);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(cv::countNonZero(out), 64 * 64) << "at most 32 px to each side";
  EXPECT_LT(took.count(), 20) << "the whole image for each pixel would take minutes";
}

TEST_F(FrameConversion, DistortionIsRemoved) {
  auto images = makeImages(5, 64, 48);
  for (auto* camera : {&images->cameraParams, &images->cameraParamsIntensity}) {
    camera->setIntrinsicParamsFromValues(50, 50, 31.5, 23.5);
    camera->setDistortionPlumbBob(-0.3, 0, 0, 0);
  }
  images->rangeImage.fill(0);
  // The ray (0.4, 0) meets the sensor at r (1 + k1 r^2) = 0.4 * 0.952 = 0.3808: u = 31.5 + 50 * 0.3808
  // = 50.54.
  for (int u = 50; u <= 51; ++u)
    for (int v = 22; v <= 25; ++v) images->rangeImage(v, u) = 3000;
  const auto frame = readBack(images);
  EXPECT_NEAR(frame.depthAt(31.5 + 50 * 0.4, 23.5), 3, 1e-5);
  EXPECT_EQ(frame.camera.distortion, (std::array<double, 5>{}));
  EXPECT_FLOAT_EQ(frame.depthAt(49, 23), 0);
}

TEST_F(FrameConversion, DepthOnlyAndColourOnlyRecords) {
  auto depth_only = makeImages(5);
  depth_only->hasIntensityImage = false;
  const auto first = readBack(depth_only);
  EXPECT_TRUE(first.color.empty());
  EXPECT_TRUE(first.hasDepth());
  EXPECT_TRUE(first.robot_from_camera.linear().isApprox(bodyFromOptical(), 1e-9));
  auto color_only = makeImages(5);
  color_only->hasRangeImage = false;
  const auto second = readBack(color_only);
  EXPECT_FALSE(second.hasDepth());
  EXPECT_EQ(second.gray.size(), cv::Size(16, 12));
}

TEST_F(FrameConversion, MissingIntrinsicsAreAReason) {
  auto images = makeImages(5);
  images->cameraParamsIntensity.setIntrinsicParamsFromValues(0, 0, 0, 0);
  EXPECT_THROW(readBack(images), std::runtime_error);
  EXPECT_THAT(statistics_.skipped, ElementsAre(Pair(testing::HasSubstr("no camera intrinsics"), 1)));
}

TEST_F(FrameConversion, IntrinsicsOfAnotherImageSizeAreScaledUnlessItsShapeDiffers) {
  mrpt::img::TCamera calibration;
  calibration.ncols = 640;
  calibration.nrows = 480;
  calibration.setIntrinsicParamsFromValues(500, 510, 320, 250);
  const PinholeCamera half = cameraForImage(calibration, 320, 240);
  EXPECT_TRUE(half.valid());
  EXPECT_DOUBLE_EQ(half.fx, 250);
  EXPECT_DOUBLE_EQ(half.fy, 255);
  EXPECT_FALSE(cameraForImage(calibration, 320, 180).valid()) << "cropped or stretched, nobody knows";
}

TEST_F(FrameConversion, ExternalImagesAreReadAndMissingOnesCounted) {
  const auto images_folder = folder_.file("x_Images");
  std::filesystem::create_directory(images_folder);
  std::vector<Object> objects;
  for (int i = 0; i < 3; ++i) {
    auto images = makeImages(i + 1);
    const std::string name = "KINECT_" + std::to_string(i);
    images->rangeImage_convertToExternalStorage(name + "_depth.bin", images_folder.string() + "/");
    ASSERT_TRUE(images->intensityImage.saveToFile((images_folder / (name + "_color.png")).string()));
    images->intensityImage.setExternalStorage(name + "_color.png");
    objects.push_back(images);
  }
  writeRawlog(folder_.file("x.rawlog"), objects);
  std::filesystem::remove(images_folder / "KINECT_0_color.png");
  std::filesystem::remove(images_folder / "KINECT_1_depth.bin");
  RawlogReader reader(folder_.file("x.rawlog"));
  const auto record = reader.next();
  ASSERT_TRUE(record) << testing::PrintToString(reader.statistics().skipped);
  const auto& frame = std::get<Frame>(*record);
  EXPECT_NEAR(frame.t, 3, 1e-6);
  EXPECT_EQ(frame.color.at<cv::Vec3b>(6, 8), cv::Vec3b(20, 108, 200));
  EXPECT_NEAR(frame.depth.at<float>(3, 7), 1.07, 1e-6);
  EXPECT_FALSE(reader.next());
  // Both missing files count under one reason, which names the first.
  ASSERT_EQ(reader.statistics().skipped.size(), 1u);
  const auto& [reason, count] = *reader.statistics().skipped.begin();
  EXPECT_EQ(count, 2);
  EXPECT_THAT(reason, StartsWith("image missing: "));
  EXPECT_THAT(reason, testing::HasSubstr("KINECT_0_color.png"));
}

// Where a pixel of a pinhole camera lies in the image of the lens; formulas of OpenCV's documentation.
Eigen::Vector2d throughFisheye(const Eigen::Vector2d& ray, const std::array<double, 4>& k) {
  const double r = ray.norm(), a = std::atan(r), a2 = a * a;
  return r < 1e-12 ? ray : Eigen::Vector2d(ray / r * a * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))));
}
Eigen::Vector2d throughRational(const Eigen::Vector2d& ray, const std::array<double, 8>& d) {
  const double r2 = ray.squaredNorm();
  const double scale = (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  const double x = ray.x(), y = ray.y();
  return {x * scale + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x), y * scale + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

TEST_F(FrameConversion, RaysOfAFisheyeLensComeFromItsPixels) {
  const PinholeCamera camera{64, 48, 40, 40, 31.5, 23.5, {}};
  const std::array<double, 4> k{-0.05, 0.02, -0.01, 0.004};
  const cv::Mat rays = pixelRays(camera, {"equidistant", {k.begin(), k.end()}});
  for (int v = 0; v < 48; v += 5)
    for (int u = 0; u < 64; u += 5) {
      const auto ray = rays.at<cv::Vec2f>(v, u);
      const Eigen::Vector2d there = 40 * throughFisheye({ray[0], ray[1]}, k) + Eigen::Vector2d(31.5, 23.5);
      EXPECT_NEAR((there - Eigen::Vector2d(u, v)).norm(), 0, 1e-3) << u << ' ' << v;
    }
}

// Depth, 1 m and a centimetre more for each column, tells from which column a pixel was taken.
TEST_F(FrameConversion, LensesOfOtherModelsAreTakenOutOfTheImages) {
  const std::array<double, 4> fisheye{-0.05, 0.02, -0.01, 0.004};
  const std::array<double, 8> rational{0.5, -0.27, 0.01, -0.02, 0.16, 0.38, -0.25, 0.15};
  for (const bool is_fisheye : {true, false}) {
    auto images = makeImages(5, 64, 48);
    auto& camera = images->cameraParams;
    camera.setIntrinsicParamsFromValues(50, 50, 31.5, 23.5);
    if (is_fisheye) {
      camera.setDistortionKannalaBrandt(fisheye[0], fisheye[1], fisheye[2], fisheye[3]);
    } else {
      camera.distortion = mrpt::img::DistortionModel::plumb_bob;
      std::copy(rational.begin(), rational.end(), camera.dist.begin());
    }
    images->cameraParamsIntensity = camera;
    const Frame frame = readBack(images);
    EXPECT_EQ(frame.camera.distortion, (std::array<double, 5>{}));
    int moved = 0;
    for (int v = 0; v < 48; v += 3)
      for (int u = 0; u < 64; u += 3) {
        const Eigen::Vector2d ray((u - 31.5) / 50, (v - 23.5) / 50);
        const Eigen::Vector2d there = 50 * (is_fisheye ? throughFisheye(ray, fisheye) : throughRational(ray, rational)) + Eigen::Vector2d(31.5, 23.5);
        if (there.x() < 1 || there.x() > 62 || there.y() < 1 || there.y() > 46) continue;
        EXPECT_NEAR(frame.depth.at<float>(v, u), 1 + 0.01 * there.x(), 0.0056) << is_fisheye << ' ' << u << ' ' << v;
        moved += std::abs(there.x() - u) > 1;
      }
    EXPECT_GT(moved, 30) << is_fisheye;
  }
}

// What was computed for one camera must not serve another, nor be lost on the way back to the first.
TEST_F(FrameConversion, CamerasThatTakeTurnsAreToldApart) {
  struct Camera {
    double f, cx, cy, k1;
  };
  const std::vector<Camera> cameras{{50, 31.5, 23.5, -0.2}, {55, 31.5, 23.5, -0.2}, {50, 29, 23.5, -0.2}, {50, 31.5, 26, -0.2}, {50, 31.5, 23.5, 0.1}};
  for (std::size_t i = 0; i < 3 * cameras.size(); ++i) {
    const auto& [f, cx, cy, k1] = cameras[i * 2 % cameras.size()];
    auto images = makeImages(5, 64, 48);
    images->cameraParams.setIntrinsicParamsFromValues(f, f, cx, cy);
    images->cameraParams.setDistortionPlumbBob(k1, 0, 0, 0, 0);
    images->cameraParamsIntensity = images->cameraParams;
    const Frame frame = readBack(images);
    const Eigen::Vector2d ray((55 - cx) / f, (40 - cy) / f);
    const double column = cx + f * ray.x() * (1 + k1 * ray.squaredNorm());
    EXPECT_NEAR(frame.depth.at<float>(40, 55), 1 + 0.01 * column, 0.0056) << i;
  }
}

TEST_F(FrameConversion, RangesOfCamerasThatTakeTurns) {
  for (const double f : {50, 60, 50, 70, 80, 50}) {
    auto images = makeImages(5, 64, 48);
    images->cameraParams.setIntrinsicParamsFromValues(f, f, 31.5, 23.5);
    images->cameraParamsIntensity = images->cameraParams;
    images->range_is_depth = false;
    const double along = std::hypot(1, (60 - 31.5) / f, (44 - 23.5) / f);
    EXPECT_NEAR(readBack(images).depth.at<float>(44, 60), 1.60 / along, 1e-3) << f;
  }
}

}  // namespace
}  // namespace roomgraph
