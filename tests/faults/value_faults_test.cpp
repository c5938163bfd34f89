// SPDX-License-Identifier: BSD-3-Clause
// Faults of values: what becomes no number, statistics of the noise, uniform pictures, poses of sensors.
#include "value_faults.h"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "image_faults.h"
#include "passing_records.h"
#include "pose_fault.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

using namespace test;
using enum FaultySensor;

const StruckSensors kMeasuringSensors{kCamera, kLidar, kOdometry};
const FaultWindow kAlways{0, std::numeric_limits<double>::infinity()};

cv::Mat pixelsOf(const PassingRecord& record) {
  return imagesOf(record).intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
}

TEST(NotANumberFault, StrikesAFifthOfTheBeamsMarkedValid) {
  constexpr int kBeams = 5000;
  NotANumberFault fault({kLidar}, {0, 1}, Random(1));
  const auto out =
      through(fault, {passing(makeScan(kStart_s, 2, kBeams)), passing(makeScan(kStart_s + 1, 2, kBeams))});
  int none = 0, plus = 0, minus = 0, finite = 0;
  const auto& scan = scanOf(out[0]);
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const float range = scan.getScanRange(i);
    EXPECT_TRUE(scan.getScanRangeValidity(i));
    EXPECT_TRUE(!std::isfinite(range) || range == 2 + 0.1f * static_cast<float>(i));
    finite += std::isfinite(range);
    none += std::isnan(range);
    plus += std::isinf(range) && range > 0;
    minus += std::isinf(range) && range < 0;
  }
  const double sigma = std::sqrt(kBeams * 0.2 * 0.8);
  EXPECT_NEAR(none + plus + minus, 0.2 * kBeams, 5 * sigma);
  EXPECT_EQ(finite + none + plus + minus, kBeams);
  EXPECT_NEAR(none, plus, 1);
  EXPECT_NEAR(plus, minus, 1);
  EXPECT_TRUE(keepsBytes(out[1]));
}

TEST(NotANumberFault, StrikesOdometryCoordinatesInTurnAndTheDepthUnit) {
  NotANumberFault fault(kMeasuringSensors, kAlways, Random(1));
  const auto out = through(fault, {odometryAt(0, 1, 2, 3), odometryAt(1, 1, 2, 3), odometryAt(2, 1, 2, 3),
                                   imagesAt(3), boxesAt(4)});
  EXPECT_TRUE(std::isnan(odometryOf(out[0]).x()));
  EXPECT_EQ(odometryOf(out[0]).y(), 2);
  EXPECT_TRUE(std::isinf(odometryOf(out[1]).y()));
  EXPECT_EQ(odometryOf(out[1]).phi(), 3);
  EXPECT_FALSE(std::isfinite(odometryOf(out[2]).phi()));
  EXPECT_FALSE(std::isfinite(imagesOf(out[3]).rangeUnits));
  EXPECT_TRUE(keepsBytes(out[4])) << "detections hold no ranges";
  EXPECT_EQ(fault.counts(), (Counts{{"KINECT", 1}, {"ODOMETRY", 3}}));
}

TEST(NoiseFault, ScansGetNoiseOfTheStatedSize) {
  constexpr int kBeams = 20000;
  auto scan = makeScan(kStart_s, 4, kBeams);
  for (std::size_t i = 0; i < kBeams; ++i) {
    scan->setScanRange(i, 4);
    scan->setScanRangeValidity(i, i % 2 == 0);
  }
  NoiseFault fault({kLidar}, kAlways, 2, Random(3));
  const auto out = through(fault, {passing(scan)});
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < kBeams; i += 2) {
    const double error = static_cast<double>(scanOf(out[0]).getScanRange(i)) - 4;
    sum += error;
    squares += error * error;
    EXPECT_EQ(scanOf(out[0]).getScanRange(i + 1), 4) << "a beam without return has nothing to be noisy";
  }
  const double count = kBeams / 2.0;
  EXPECT_NEAR(sum / count, 0, 5 * 0.6 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.6, 0.02);
}

TEST(NoiseFault, PicturesDepthsAndOdometryGetTheirs) {
  const PassingRecord images = passing(makeImages(kStart_s, 160, 120));
  NoiseFault fault(kMeasuringSensors, kAlways, 1, Random(3));
  PassingRecords records{images};
  for (int i = 0; i < 1000; ++i) records.push_back(odometryAt(i, 1, 2, 0));
  const auto out = through(fault, records);
  EXPECT_EQ(imagesOf(out[0]).rangeImage(0, 0), 0) << "no measurement stays none";
  double squares = 0;
  for (int v = 1; v < 120; ++v)
    for (int u = 0; u < 160; ++u)
      squares += std::pow(imagesOf(out[0]).rangeImage(v, u) - imagesOf(images).rangeImage(v, u), 2);
  EXPECT_NEAR(std::sqrt(squares / (119 * 160)), 100, 3);  // mm
  cv::Mat difference, channels[3];
  pixelsOf(out[0]).convertTo(difference, CV_32F);
  cv::Mat before;
  pixelsOf(images).convertTo(before, CV_32F);
  cv::split(difference - before, channels);
  cv::Scalar mean, deviation;
  cv::meanStdDev(channels[1](cv::Rect(0, 0, 20, 120)), mean, deviation);  // 100 to 120: far from both ends
  EXPECT_NEAR(deviation[0], 40, 3);
  double turns = 0, ways = 0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    turns += std::pow(odometryOf(out[i]).phi(), 2);
    ways += std::pow(odometryOf(out[i]).x() - 1, 2) + std::pow(odometryOf(out[i]).y() - 2, 2);
  }
  EXPECT_NEAR(std::sqrt(turns / 1000), 0.1, 0.01);
  EXPECT_NEAR(std::sqrt(ways / 2000), 0.1, 0.01);
}

TEST(NoiseFault, TheSameSeedGivesTheSameNoise) {
  const auto noisy = [](std::uint64_t seed) {
    NoiseFault fault({kLidar}, kAlways, 1, Random(seed));
    return bytesOf(through(fault, {scanAt(0)})[0].observation);
  };
  EXPECT_EQ(noisy(1), noisy(1));
  EXPECT_NE(noisy(1), noisy(2));
}

TEST(UniformPictureFault, PicturesOfOneLevelWithoutDetectionsDepthAsItWas) {
  for (const int level : {0, 255}) {
    UniformPictureFault fault(static_cast<std::uint8_t>(level), {1, 2});
    const auto out = through(fault, {imagesAt(0), boxesAt(1), imagesAt(1), scanAt(1), imagesAt(2)});
    EXPECT_TRUE(keepsBytes(out[0]));
    const auto boxes = fromComment(as<mrpt::obs::CObservationComment>(out[1]));
    ASSERT_TRUE(boxes);
    EXPECT_TRUE((*boxes)->items.empty());
    EXPECT_EQ((*boxes)->sensorLabel, "BOXES");
    double low = 0, high = 0;
    cv::minMaxLoc(pixelsOf(out[2]).reshape(1), &low, &high);
    EXPECT_EQ(low, level);
    EXPECT_EQ(high, level);
    EXPECT_EQ(imagesOf(out[2]).rangeImage, imagesOf(out[0]).rangeImage);
    EXPECT_TRUE(keepsBytes(out[4]));
    EXPECT_EQ(fault.counts(), (Counts{{"BOXES", 1}, {"KINECT", 1}}));
  }
}

TEST(NoDepthFault, EmptiesDepthAndKeepsColour) {
  NoDepthFault fault({1, 2});
  const auto out = through(fault, {imagesAt(0), imagesAt(1)});
  EXPECT_TRUE(keepsBytes(out[0]));
  EXPECT_EQ(imagesOf(out[1]).rangeImage.maxCoeff(), 0);
  EXPECT_EQ(imagesOf(out[1]).rangeImage.rows(), 12);
  EXPECT_EQ(cv::norm(pixelsOf(out[0]), pixelsOf(out[1]), cv::NORM_INF), 0);
  EXPECT_EQ(fault.counts(), (Counts{{"KINECT", 1}}));
}

TEST(WrongExtrinsicsFault, MovesAlongTheRobotsAxesAndTurnsAboutTheSensorsPlace) {
  // A camera on the left that looks to the left; pitched down by 10 degrees about the robot's left axis.
  PassingRecord images = imagesAt(1);
  images.observation->setSensorPose(mrpt::poses::CPose3D(0.1, 0.5, 1.2, 90 * kDegree, 0, 0));
  const Pose3 error = poseFromYpr(0, 0, 0.2, 0, 10 * kDegree, 0);
  WrongExtrinsicsFault fault(kCamera, error, {1, 2});
  const auto out = through(fault, {images, imagesAt(2), scanAt(1)});
  const Pose3 after = toPose3(imagesOf(out[0]).sensorPose);
  EXPECT_NEAR((after.translation() - Eigen::Vector3d(0.1, 0.5, 1.4)).norm(), 0, 1e-9);
  // Its view is along the axis of the turn and stays; its right side, the robot's front, goes down.
  EXPECT_NEAR((after.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0, 1e-9);
  const Eigen::Vector3d right = after.linear() * -Eigen::Vector3d::UnitY();
  EXPECT_NEAR((right - Eigen::Vector3d(std::cos(10 * kDegree), 0, -std::sin(10 * kDegree))).norm(), 0, 1e-9);
  EXPECT_TRUE(keepsBytes(out[1]));
  EXPECT_TRUE(keepsBytes(out[2]));
}

}  // namespace
}  // namespace roomgraph
