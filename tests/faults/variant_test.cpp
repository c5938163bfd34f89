// SPDX-License-Identifier: BSD-3-Clause
// Variants of recordings: geometry against projection and beams by hand, order and stamps, truths, errors.
#include "roomgraph/faults/variant.h"

#include <gmock/gmock.h>

#include <opencv2/calib3d.hpp>

#include "../datasets/rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/datasets/stored_observations.h"
#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/detection_comment.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Kind = VariantTruth::Kind;

mrpt::obs::CObservationComment::Ptr makeBoxes(double t) {
  CObservationDetections detections;
  detections.timestamp = mrpt::Clock::fromDouble(t);
  detections.sensorLabel = "DETECTIONS";
  detections.image_width = 16;
  detections.image_height = 12;
  detections.items.push_back({"chair", 0.9, 1, 2, 5, 8});
  detections.items[0].mask = {4, 1, {1, 1, 2}};  // the second of four pixels
  return std::make_shared<mrpt::obs::CObservationComment>(toComment(detections));
}

class Variant : public ::testing::Test {
 protected:
  VariantResult vary(const std::vector<Object>& records, const VariantOptions& options,
                     const std::vector<VariantTruth>& truths = {}) {
    writeRawlog(in, records);
    return writeVariant(in, out, options, truths);
  }
  std::vector<StoredObservation> read() const {
    StoredObservationReader reader(out);
    std::vector<StoredObservation> all;
    while (auto next = reader.next()) all.push_back(std::move(*next));
    EXPECT_TRUE(reader.skipped().empty());
    return all;
  }
  template <class Observation>
  typename Observation::Ptr only() const {
    const auto all = read();
    EXPECT_EQ(all.size(), 1u);
    const auto observation = std::dynamic_pointer_cast<Observation>(all.at(0).observation);
    EXPECT_TRUE(observation);
    return observation;
  }
  std::vector<std::pair<std::string, double>> order() const {
    std::vector<std::pair<std::string, double>> labels;
    for (const auto& [observation, bytes] : read())
      labels.emplace_back(observation->sensorLabel,
                          std::round(1e3 * mrpt::Clock::toDouble(observation->timestamp)) / 1e3);
    return labels;
  }
  std::string truthText(Kind kind, const std::string& text, const std::vector<Object>& records,
                        const VariantOptions& options) {
    writeBytes(folder.file("truth"), text);
    vary(records, options, {{kind, folder.file("truth"), folder.file("other")}});
    return readTextFile(folder.file("other"));
  }

  TemporaryFolder folder;
  std::filesystem::path in = folder.file("x.rawlog"), out = folder.file("y.rawlog");
};

std::vector<Eigen::Vector3d> pointsOfScan(const mrpt::obs::CObservation2DRangeScan& observation) {
  return toScan(observation).pointsInRobot();
}

TEST_F(Variant, BackwardsTheLastComesFirstAndRecordsOfOneStampStayInOrder) {
  auto reading = makeOdometry(101, 1, 0, 0);
  reading->hasVelocities = reading->hasEncodersInfo = true;
  reading->velocityLocal = {0.5, 0.1, 0.2};
  const auto result = vary({makeOdometry(100, 0, 0, 0), makeScan(100), makeImages(100.5), reading, makeScan(101)}, {.backwards = true});
  EXPECT_EQ(result.read, 5);
  EXPECT_EQ(result.written, 5);
  EXPECT_THAT(order(), ElementsAre(std::pair("ODOMETRY", 100.0), std::pair("LASER", 100.0), std::pair("KINECT", 100.5),
                                   std::pair("ODOMETRY", 101.0), std::pair("LASER", 101.0)));
  const auto first = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(read()[0].observation);
  EXPECT_EQ(first->odometry.x(), 1);
  EXPECT_EQ(first->velocityLocal.vx, -0.5);
  EXPECT_EQ(first->velocityLocal.vy, -0.1);
  EXPECT_EQ(first->velocityLocal.omega, -0.2);
  EXPECT_FALSE(first->hasEncodersInfo);
}

TEST_F(Variant, StampsAreMadeAnewInTheOrderOfTheFile) {
  const std::vector<Object> jumbled{makeOdometry(100, 0, 0, 0), makeScan(100), makeScan(107), makeScan(101)};
  vary(jumbled, {.stamps_apart_s = 0.5});
  EXPECT_THAT(order(), ElementsAre(std::pair("ODOMETRY", 100.0), std::pair("LASER", 100.0), std::pair("LASER", 100.5),
                                   std::pair("LASER", 101.0)));
  EXPECT_EQ(truthText(Kind::kRelations, "107.0004 101.0004 1 2 0 0 0 0.5\n", jumbled, {.stamps_apart_s = 0.5, .backwards = true}),
            "100.500000 100.000000 1 2 0 0 0 0.5\n");
  EXPECT_THAT([&] { truthText(Kind::kRelations, "# c\n107 105 1 2 0 0 0 0.5\n", jumbled, {.stamps_apart_s = 0.5}); },
              ThrowsMessage<InputError>(HasSubstr("truth:2: no record has this time")));
}

TEST_F(Variant, MirroredScansHaveTheirPointsOnTheOtherSide) {
  auto scan = makeScan(100);
  scan->sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0, 0);
  const auto before = pointsOfScan(*scan);
  vary({scan}, {.mirrored = true});
  const auto after = pointsOfScan(*only<mrpt::obs::CObservation2DRangeScan>());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(after[i].x(), before[i].x(), 1e-6);
    EXPECT_NEAR(after[i].y(), -before[i].y(), 1e-6);
  }
}

// Where OpenCV projects a point of the robot's frame.
cv::Point2d projected(const mrpt::obs::CObservation3DRangeScan& images, const Eigen::Vector3d& point) {
  mrpt::poses::CPose3D sensor;
  images.getSensorPose(sensor);
  const Pose3 camera = toPose3(sensor) * toPose3(images.relativePoseIntensityWRTDepth);
  const Eigen::Vector3d p = camera.inverse() * point;
  const auto& lens = images.cameraParamsIntensity;
  const cv::Matx33d k(lens.fx(), 0, lens.cx(), 0, lens.fy(), lens.cy(), 0, 0, 1);
  const cv::Mat distortion(1, 5, CV_64F, const_cast<double*>(lens.dist.data()));
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, distortion, pixels);
  return pixels.at(0);
}

TEST_F(Variant, MirroredImagesSeeMirroredPointsAtTheOtherEnd) {
  auto images = makeImages(100);
  images->setSensorPose(mrpt::poses::CPose3D(0.1, 0.2, 1, 0.3, -0.2, 0.1));
  images->relativePoseIntensityWRTDepth =
      mrpt::poses::CPose3D(0.01, -0.05, 0.02, -90 * M_PI / 180, 0.02, -90 * M_PI / 180);
  images->cameraParamsIntensity.cx(6);
  for (int i = 0; i < 5; ++i) images->cameraParamsIntensity.dist[static_cast<std::size_t>(i)] = 0.02 * (i + 1);
  const Eigen::Vector3d point(2, 0.6, 1.2), other(2, -0.6, 1.2);
  const auto before = projected(*images, point);
  const int red = images->intensityImage.at<std::uint8_t>(3, 2, 2), depth = images->rangeImage(2, 3);
  vary({images}, {.mirrored = true});
  const auto after = only<mrpt::obs::CObservation3DRangeScan>();
  EXPECT_NEAR(projected(*after, other).x, 15 - before.x, 1e-6);
  EXPECT_NEAR(projected(*after, other).y, before.y, 1e-6);
  EXPECT_EQ(after->intensityImage.at<std::uint8_t>(12, 2, 2), red);
  EXPECT_EQ(after->rangeImage(2, 12), depth);
}

TEST_F(Variant, MirroredBoxesAndWheelsAreOnTheOtherSide) {
  vary({makeBoxes(100)}, {.mirrored = true});
  const auto boxes = fromComment(*only<mrpt::obs::CObservationComment>());
  ASSERT_TRUE(boxes);
  const auto& item = (*boxes)->items.at(0);
  EXPECT_THAT((std::vector<double>{item.u_min, item.v_min, item.u_max, item.v_max}), ElementsAre(11, 2, 15, 8));
  EXPECT_THAT(item.mask.runs, ElementsAre(2, 1, 1));
  auto reading = makeOdometry(100, 1, 2, 0.5);
  reading->hasVelocities = true;
  reading->velocityLocal = {0.5, 0.1, 0.2};
  vary({reading}, {.mirrored = true});
  const auto after = only<mrpt::obs::CObservationOdometry>();
  EXPECT_THAT((std::vector<double>{after->odometry.x(), after->odometry.y(), after->odometry.phi()}), ElementsAre(1, -2, -0.5));
  EXPECT_THAT((std::vector<double>{after->velocityLocal.vx, after->velocityLocal.vy, after->velocityLocal.omega}),
              ElementsAre(0.5, -0.1, -0.2));
}

TEST_F(Variant, BeamsThatStayKeepTheirPoints) {
  for (const bool right_to_left : {true, false}) {
    auto scan = makeScan(100);  // ranges 2 to 2.4 m
    scan->rightToLeft = right_to_left;
    scan->sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0, 0.4, 0, 0);
    const auto before = pointsOfScan(*scan);
    const auto expectPoints = [&](const VariantOptions& options, const std::vector<std::size_t>& beams) {
      vary({scan}, options);
      const auto after = pointsOfScan(*only<mrpt::obs::CObservation2DRangeScan>());
      ASSERT_EQ(after.size(), beams.size());
      for (std::size_t i = 0; i < beams.size(); ++i) EXPECT_LT((after[i] - before[beams[i]]).norm(), 1e-6) << i;
    };
    expectPoints({.every_beam = 2}, {0, 2, 4});
    expectPoints({.every_beam = 3}, {0, 3});
    expectPoints({.every_beam = 4}, {0, 4});
    expectPoints({.every_beam = 5}, {2});
    expectPoints({.field_of_view_rad = 1.01}, {1, 2, 3});  // of 2 rad, beams .5 rad apart
    expectPoints({.farthest_m = 2.25}, {0, 1, 2});
    EXPECT_FALSE(only<mrpt::obs::CObservation2DRangeScan>()->getScanRangeValidity(3));
  }
}

TEST_F(Variant, ThinnedRecordsKeepTheirBytesAndDetectionsGoWithTheirImage) {
  const std::vector<Object> records{makeScan(100), makeScan(101), makeImages(101), makeBoxes(101), makeScan(102),
                                    makeImages(102), makeBoxes(102), makeScan(103)};
  EXPECT_EQ(vary(records, {.every_scan = 3, .every_image = 2}).written, 4);
  const auto left = read();
  ASSERT_EQ(left.size(), 4u);
  for (std::size_t i = 0; const std::size_t kept : {0u, 2u, 3u, 7u}) EXPECT_EQ(left[i++].bytes, bytesOf(records[kept])) << kept;
}

TEST_F(Variant, WhatCannotBeToldIsLeftOutAndCounted) {
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->timestamp = mrpt::Clock::fromDouble(100);
  comment->text = "a human's words";
  for (const VariantOptions& options : {VariantOptions{.mirrored = true}, VariantOptions{.backwards = true}}) {
    const auto result = vary({comment, makeScan(101)}, options);
    EXPECT_EQ(result.written, 1);
    EXPECT_EQ(result.skipped, (std::map<std::string, int>{{"of a kind that cannot be mirrored or reversed", 1}}));
  }
  EXPECT_EQ(vary({comment, makeScan(101)}, {.every_scan = 2}).written, 2);
}

TEST_F(Variant, TruthsGoAlong) {
  const std::vector<Object> records{makeImages(100), makeScan(110)};
  EXPECT_EQ(truthText(Kind::kRelations, "# from to\n101 102.5 1 2 3 .1 .2 .3\n", records, {.backwards = true}),
            "# from to\n109.000000 107.500000 1 2 3 0.1 0.2 0.3\n");
  EXPECT_EQ(truthText(Kind::kRelations, "101 102.5 1 2 3 .1 .2 .3\n", records, {.mirrored = true}),
            "101.000000 102.500000 1 -2 3 -0.1 0.2 -0.3\n");
  EXPECT_EQ(truthText(Kind::kRobotTrajectory, "101 1 2 3 0 0 0 1\n\n102 1 2 4 0 0 0.6 0.8\n", records, {.mirrored = true, .backwards = true}),
            "108.000000 1 -2 4 0 0 -0.6 0.8\n109.000000 1 -2 3 0 0 0 1\n");
  const std::string box = R"({"frame":0,"t":101.5,"objects":[{"id":1,"bbox":[1,2,5,8],"full_bbox":[-3,2,5,8]}]})";
  EXPECT_EQ(truthText(Kind::kBoxes, box, records, {.mirrored = true, .backwards = true}),
            R"({"frame":0,"t":108.5,"objects":[{"id":1,"bbox":[11.0,2,15.0,8],"full_bbox":[11.0,2,19.0,8]}]})"
            "\n");
  EXPECT_EQ(truthText(Kind::kBoxes, R"({"timestamp":101,"boxes":[{"class":"chair","bbox":[1,2,5,8]}]})", records, {.mirrored = true}),
            "{\"timestamp\":101.0,\"boxes\":[{\"class\":\"chair\",\"bbox\":[11.0,2,15.0,8]}]}\n");
}

// A point of the world in the camera's frame is its mirror image in the mirrored camera's.
TEST_F(Variant, MirroredCamerasSeeTheMirroredWorld) {
  const Pose3 camera = toPose3(mrpt::poses::CPose3D(1, 2, 3, 0.4, -0.3, 0.2)) * Pose3(bodyFromOptical());
  const Eigen::Quaterniond q(camera.rotation());
  std::ostringstream line;
  line.precision(12);
  line << "101 1 2 3 " << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "\n";
  std::istringstream text(truthText(Kind::kCameraTrajectory, line.str(), {makeImages(100)}, {.mirrored = true}));
  double t, x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(text >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  const Pose3 other = Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz);
  const Eigen::Vector3d seen = camera.inverse() * Eigen::Vector3d(4, 5, 6);
  const Eigen::Vector3d mirrored = other.inverse() * Eigen::Vector3d(4, -5, 6);
  EXPECT_LT((mirrored - Eigen::Vector3d(-seen.x(), seen.y(), seen.z())).norm(), 1e-6);
}

TEST_F(Variant, ErrorsNameWhatIsWrong) {
  const std::vector<Object> records{makeScan(100)};
  const auto expectConfig = [&](const VariantOptions& options, const char* text) {
    EXPECT_THAT([&] { vary(records, options); }, ThrowsMessage<ConfigError>(HasSubstr(text)));
  };
  expectConfig({}, "no change is asked for");
  expectConfig({.every_scan = 0}, "every first");
  expectConfig({.farthest_m = -1}, "above 0");
  expectConfig({.stamps_apart_s = -1}, "above 0");
  EXPECT_THAT([&] { truthText(Kind::kRelations, "1 2 3\n", records, {.backwards = true}); },
              ThrowsMessage<InputError>(HasSubstr("truth:1: has 3 numbers, expected 8")));
  EXPECT_THAT([&] { truthText(Kind::kRelations, "1 2 3 x 5 6 7 8\n", records, {.backwards = true}); },
              ThrowsMessage<InputError>(HasSubstr("truth:1: 'x' is not a number")));
  EXPECT_THAT([&] { truthText(Kind::kBoxes, "{\"t\":1,\"objects\":[]}\n", records, {.mirrored = true}); },
              ThrowsMessage<InputError>(HasSubstr("truth:1: boxes cannot be mirrored")));
  EXPECT_THAT([&] { truthText(Kind::kBoxes, "{}\n", records, {.backwards = true}); },
              ThrowsMessage<InputError>(HasSubstr("truth:1: ")));
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_THAT([&] { writeVariant(in, in, {.backwards = true}); }, ThrowsMessage<ConfigError>(HasSubstr("x.rawlog")));
}

}  // namespace
}  // namespace roomgraph
