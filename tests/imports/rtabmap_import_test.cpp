// SPDX-License-Identifier: BSD-3-Clause
// Databases in the layout of RTAB-Map, which we wrote ourselves: every record as it was meant, every fault in
// a line.
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>
#include <numbers>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "rtabmap_maker.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

// Nodes of a rawlog: one at each image, with the scan and the odometry of its time.
std::vector<NodeRow> nodesOf(const std::vector<mrpt::obs::CObservation::Ptr>& records) {
  std::vector<NodeRow> rows;
  const auto wheels = only<CObservationOdometry>(records);
  const auto scans = only<CObservation2DRangeScan>(records);
  const auto nearest = [](const auto& all, double t) {
    return *std::min_element(all.begin(), all.end(), [t](const auto& a, const auto& b) {
      return std::abs(secondsOf(*a) - t) < std::abs(secondsOf(*b) - t);
    });
  };
  for (const auto& images : only<CObservation3DRangeScan>(records)) {
    NodeRow row{static_cast<int>(rows.size()) + 1, 0, secondsOf(*images)};
    const auto& odometry = nearest(wheels, row.stamp)->odometry;
    row.pose = transformBytes(toPose3(Pose2{odometry.x(), odometry.y(), odometry.phi()}));
    row.image = encoded(images->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY));
    row.depth =
        encoded(cv::Mat(static_cast<int>(images->rangeImage.rows()),
                        static_cast<int>(images->rangeImage.cols()), CV_16UC1, images->rangeImage.data()));
    Pose3 forward_from_optical = Pose3::Identity();
    forward_from_optical.linear() = bodyFromOptical();
    const auto& camera = images->cameraParamsIntensity;
    row.calibration =
        cameraBytes(static_cast<int>(camera.ncols), static_cast<int>(camera.nrows), camera.fx(), camera.cx(),
                    camera.cy(), toPose3(images->sensorPose) * forward_from_optical);
    const auto scan = nearest(scans, row.stamp);
    const double step = scan->aperture / static_cast<double>(scan->getScanSize() - 1);
    std::vector<float> points;
    for (std::size_t i = 0; i < scan->getScanSize(); ++i) {
      const double angle = -0.5 * scan->aperture + step * static_cast<double>(i);
      if (!scan->getScanRangeValidity(i)) continue;
      points.push_back(static_cast<float>(scan->getScanRange(i) * std::cos(angle)));
      points.push_back(static_cast<float>(scan->getScanRange(i) * std::sin(angle)));
    }
    row.scan = scanBytes(points, 2);
    row.scan_info = scanInfoBytes(1, scan->maxRange, -0.5f * scan->aperture, 0.5f * scan->aperture,
                                  static_cast<float>(step), toPose3(scan->sensorPose));
    rows.push_back(row);
  }
  return rows;
}

void expectPlace(const mrpt::poses::CPose3D& pose, const mrpt::poses::CPose3D& wanted) {
  EXPECT_LT((pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>() -
             wanted.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>())
                .sum_abs(),
            1e-5);
}

TEST(RtabmapImport, NodesOfARawlogGiveItsRecords) {
  const auto room = recordsIn(kTinyRoom);
  const ImportedDatabase database(nodesOf(room));
  EXPECT_THAT(database.result.warnings, IsEmpty());
  EXPECT_THAT(database.result.skipped, IsEmpty());
  EXPECT_EQ(database.result.version, "0.20.16");
  const auto wanted = only<CObservation3DRangeScan>(room),
             images = only<CObservation3DRangeScan>(database.records);
  ASSERT_EQ(images.size(), wanted.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_NEAR(secondsOf(*images[i]), secondsOf(*wanted[i]), 2e-6);
    EXPECT_EQ(cv::norm(images[i]->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY),
                       wanted[i]->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY)),
              0);
    ASSERT_EQ(images[i]->rangeImage.rows(), wanted[i]->rangeImage.rows());
    EXPECT_TRUE(images[i]->rangeImage == wanted[i]->rangeImage);
    EXPECT_FLOAT_EQ(images[i]->rangeUnits, wanted[i]->rangeUnits);
    EXPECT_DOUBLE_EQ(images[i]->cameraParams.fx(), wanted[i]->cameraParams.fx());
    EXPECT_TRUE(ObservationReader::isRegistered(*images[i]));
    expectPlace(images[i]->sensorPose, wanted[i]->sensorPose);
  }
  const auto scans = only<CObservation2DRangeScan>(database.records),
             wanted_scans = only<CObservation2DRangeScan>(room);
  ASSERT_EQ(scans.size(), images.size());
  EXPECT_NEAR(scans[0]->aperture, wanted_scans[0]->aperture, 1e-4);
  // The two ends of the full circle are one direction.
  for (std::size_t i = 1; i < 359; ++i) {
    ASSERT_EQ(scans[5]->getScanRangeValidity(i), wanted_scans[5]->getScanRangeValidity(i)) << i;
    if (wanted_scans[5]->getScanRangeValidity(i)) {
      EXPECT_NEAR(scans[5]->getScanRange(i), wanted_scans[5]->getScanRange(i), 1e-5) << i;
    }
  }
  expectPlace(scans[5]->sensorPose, wanted_scans[5]->sensorPose);
  EXPECT_EQ(only<CObservationOdometry>(database.records).size(), images.size());
}

TEST(RtabmapImport, OdometryIsThatOfTheNodes) {
  const ImportedDatabase database({smallNode(1, 1.7e9), smallNode(2, 1.7e9 + 1)});
  const auto wheels = only<CObservationOdometry>(database.records);
  ASSERT_EQ(wheels.size(), 2u);
  EXPECT_NEAR(wheels[1]->odometry.x(), 0.2, 1e-6);
  EXPECT_NEAR(wheels[1]->odometry.phi(), 0.02, 1e-6);
  EXPECT_EQ(
      ImportedDatabase({smallNode()}, {.odometry = NodeOdometry::kNone}).result.written.count("ODOMETRY"),
      0u);
}

TEST(RtabmapImport, PosesInTheAirAreNoOdometry) {
  auto up = smallNode(2, 1.7e9 + 1);
  up.pose = transformBytes(poseFromYpr(0, 0, 0.3, 0, 0, 0));
  const ImportedDatabase database({smallNode(1), up});
  EXPECT_THAT(database.result.warnings, ElementsAre(HasSubstr("do not stay on a floor")));
  EXPECT_THAT(only<CObservationOdometry>(database.records), IsEmpty());
  EXPECT_EQ(
      ImportedDatabase({smallNode(1), up}, {.odometry = NodeOdometry::kPlanar}).result.written.at("ODOMETRY"),
      2);
  up.pose = transformBytes(poseFromYpr(0, 0, 0, 0, 0.1, 0));
  EXPECT_THAT(ImportedDatabase({smallNode(1), up}).result.warnings,
              ElementsAre(HasSubstr("do not stay on a floor")));
}

TEST(RtabmapImport, DepthOfEveryEncoding) {
  cv::Mat metres(12, 16, CV_32FC1, cv::Scalar(2.5));
  metres.at<float>(3, 4) = std::numeric_limits<float>::quiet_NaN();
  auto row = smallNode();
  row.depth = floatDepthBytes(metres);
  const ImportedDatabase database({row});
  const auto images = only<CObservation3DRangeScan>(database.records).at(0);
  EXPECT_NEAR(images->rangeImage(0, 0) * images->rangeUnits, 2.5, 1e-4);
  EXPECT_EQ(images->rangeImage(3, 4), 0);
  // RVL of eight pixels: one zero, then seven of 1000: nibbles 1, 7, the difference 1000 as 2000 = 0o3720 (8
  // a f 3), six times 0.
  auto tiny = smallNode();
  tiny.image = encoded(cv::Mat(2, 4, CV_8UC3, cv::Scalar(1, 2, 3)));
  tiny.calibration = cameraBytes(4, 2, 20, 1.5, 0.5, opticalAt(0.2, 0, 0.8));
  tiny.depth = {'D', 'E', 'P', 'T', 'H', 'R', 'V', 'L'};
  append<std::uint32_t>(tiny.depth, {4, 2, 0x178AF300u, 0x00000000u});
  const ImportedDatabase rvl({tiny});
  const auto small = only<CObservation3DRangeScan>(rvl.records).at(0);
  EXPECT_EQ(small->rangeImage(0, 0), 0);
  for (int i = 1; i < 8; ++i) EXPECT_EQ(small->rangeImage(i / 4, i % 4), 1000) << i;
}

TEST(RtabmapImport, RectifiedIntrinsicsCountMore) {
  auto row = smallNode();
  row.calibration = cameraBytes(16, 12, 20, 7.5, 5.5, opticalAt(0.2, 0, 0.8), 18.5);
  const auto images = only<CObservation3DRangeScan>(ImportedDatabase({row}).records).at(0);
  EXPECT_DOUBLE_EQ(images->cameraParamsIntensity.fx(), 18.5);
  EXPECT_DOUBLE_EQ(images->cameraParamsIntensity.k1(), 0) << "of rectified images";
}

TEST(RtabmapImport, SmallerDepthHasACameraOfItsOwn) {
  auto row = smallNode();
  row.depth = encoded(cv::Mat(6, 8, CV_16UC1, cv::Scalar(1500)));
  const ImportedDatabase database({row});
  auto images = only<CObservation3DRangeScan>(database.records).at(0);
  EXPECT_DOUBLE_EQ(images->cameraParams.fx(), 10);
  EXPECT_DOUBLE_EQ(images->cameraParamsIntensity.fx(), 20);
  ObservationReader reader(database.folder.file("x.rawlog"));
  const auto frame = reader.frameOf(*images);
  ASSERT_TRUE(frame) << frame.reason();
  EXPECT_NEAR(cv::mean(frame->depth, frame->depth > 0)[0], 1.5, 1e-6);
}

TEST(RtabmapImport, FirstOfSeveralCamerasIsUsed) {
  auto row = smallNode();
  cv::Mat pair(12, 32, CV_8UC3, cv::Scalar(9, 9, 9)), depth(12, 32, CV_16UC1, cv::Scalar(3000));
  pair(cv::Rect(0, 0, 16, 12)).setTo(cv::Scalar(1, 2, 3));
  depth(cv::Rect(0, 0, 16, 12)).setTo(cv::Scalar(1000));
  row.image = encoded(pair);
  row.depth = encoded(depth);
  const auto second = cameraBytes(16, 12, 25, 7, 5, opticalAt(0, 0.2, 0.8));
  row.calibration.insert(row.calibration.end(), second.begin(), second.end());
  const ImportedDatabase database({row});
  EXPECT_THAT(database.result.warnings, ElementsAre("has 2 cameras side by side: the first is imported"));
  const auto images = only<CObservation3DRangeScan>(database.records).at(0);
  EXPECT_EQ(images->intensityImage.getWidth(), 16u);
  EXPECT_EQ(images->rangeImage(5, 15), 1000);
  EXPECT_EQ(images->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY).at<cv::Vec3b>(5, 15),
            cv::Vec3b(1, 2, 3));
}

TEST(RtabmapImport, OldVersionsHaveFloats) {
  auto row = smallNode();
  row.calibration = oldCameraBytes(16, 12, 20, 7.5, 5.5, opticalAt(0.2, 0, 0.8));
  row.scan = scanBytes({1, 0, 0, 2, -3, 0, 0.5f, 0}, 2);
  append<float>(row.scan_info, {0, 8, 1});
  const auto place = transformBytes(poseFromYpr(0.1, 0, 0.3, 0, 0, 0));
  row.scan_info.insert(row.scan_info.end(), place.begin(), place.end());
  const ImportedDatabase database({row}, {}, "0.17.6");
  EXPECT_DOUBLE_EQ(only<CObservation3DRangeScan>(database.records).at(0)->cameraParams.fx(), 20);
  const auto scan = only<CObservation2DRangeScan>(database.records).at(0);
  ASSERT_EQ(scan->getScanSize(), 720u);
  EXPECT_NEAR(scan->sensorPose.z(), 0.3, 1e-6);
  std::map<int, float> seen;  // by degree
  for (std::size_t i = 0; i < 720; ++i)
    if (scan->getScanRangeValidity(i))
      seen[static_cast<int>(std::lround((static_cast<double>(i) + 0.5) * 0.5 - 180.25))] =
          scan->getScanRange(i);
  EXPECT_EQ(seen.size(), 3u);
  EXPECT_FLOAT_EQ(seen.count(0) ? seen[0] : seen[1], 0.5) << "the nearest of two";
  EXPECT_THAT(messageOf<InputError>([&] { ImportedDatabase({row}, {}, "0.11.1"); }),
              HasSubstr("before 0.11.2 is not read"));
}

TEST(RtabmapImport, TruthIsOfTheRobotOrOfTheCameraInAHand) {
  auto row = smallNode();
  row.truth = transformBytes(poseFromYpr(1, 2, 0, std::numbers::pi / 2, 0, 0));
  const ImportedDatabase robot({row});
  EXPECT_EQ(robot.result.truth, "ground_truth_pose, of the robot");
  EXPECT_THAT(robot.folder.read("x.groundtruth.txt"), HasSubstr("1700000000.000000 1 2 0 "));
  row.pose = {};
  row.calibration = cameraBytes(16, 12, 20, 7.5, 5.5, opticalAt(0.05, 0, 0));
  const ImportedDatabase held({row});
  EXPECT_EQ(held.result.truth, "ground_truth_pose, of the camera (optical frame)");
  double t, x, y, z, qx, qy, qz, qw;
  std::istringstream in(held.folder.read("x.groundtruth.txt"));
  std::string comment;
  std::getline(in, comment);
  EXPECT_EQ(comment, "# poses of the camera (optical frame)");
  ASSERT_TRUE(in >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_NEAR(y, 2.05, 1e-6) << "5 cm ahead, and ahead is y";
  const Eigen::Vector3d optical_axis = Eigen::Quaterniond(qw, qx, qy, qz) * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(optical_axis.y(), 1, 1e-6);
}

TEST(RtabmapImport, SessionsAreToldAndChosen) {
  auto rows = std::vector<NodeRow>{smallNode(1, 1.7e9), smallNode(2, 1.7e9 + 1), smallNode(3, 1.7e9 + 9)};
  rows[2].session = 1;
  const ImportedDatabase most(rows);
  EXPECT_EQ(most.result.session, 0);
  EXPECT_THAT(most.result.warnings, ElementsAre(HasSubstr("has several sessions: 0 (2 nodes), 1 (1 nodes)")));
  const ImportedDatabase other(rows, {.session = 1});
  EXPECT_EQ(other.result.written.at("RGBD"), 1);
  EXPECT_THAT(messageOf<ConfigError>([&] { ImportedDatabase(rows, {.session = 7}); }),
              HasSubstr("has no session 7; there is: 0 (2 nodes)"));
}

TEST(RtabmapImport, BrokenPartsCostThemselvesOnly) {
  auto row = [](int id) { return smallNode(id, 1.7e9 + id); };
  std::vector<NodeRow> rows{row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8), row(9)};
  rows[1].image.resize(40);
  rows[2].depth = encoded(cv::Mat(12, 16, CV_8UC1, cv::Scalar(7)));
  rows[3].calibration = {};
  rows[4].calibration.resize(60);
  rows[5].calibration = cameraBytes(16, 12, 20, 7.5, 5.5, opticalAt(0, 0, 1), 0, 1);
  rows[6].calibration = cameraBytes(32, 24, 20, 7.5, 5.5, opticalAt(0, 0, 1));
  rows[7].scan = scanBytes({1, 2, 3}, 3);
  rows[7].scan_info = scanInfoBytes(5, 8, 0, 0, 0, Pose3::Identity());
  rows[8].pose.resize(20);
  const ImportedDatabase database(rows);
  EXPECT_THAT(database.result.skipped,
              ElementsAre(Pair("depth: is no depth image (of a stereo camera?)", 1),
                          Pair("image: compressed image is damaged, or neither JPEG nor PNG", 1),
                          Pair("images: calibration is cut off", 1),
                          Pair("images: image is 16x12 px, its camera 32x24", 1),
                          Pair("images: no calibration", 1), Pair("images: stereo camera", 1),
                          Pair("pose: there is none", 1), Pair("scan: is no 2D scan", 1)));
  EXPECT_EQ(database.result.written.at("RGBD"), 3);
  EXPECT_EQ(database.result.written.at("ODOMETRY"), 8);
}

TEST(RtabmapImport, TimesThatCannotBeAreToldAndNodesSorted) {
  auto twice = smallNode(4, 1.7e9);
  const ImportedDatabase database({smallNode(1, 1.7e9 + 2), smallNode(2, 1.7e9), smallNode(3, -1), twice});
  EXPECT_THAT(database.result.skipped, Contains(Pair("node: time is not between 1970 and 2200", 1)));
  EXPECT_THAT(database.result.skipped, Contains(Pair("node: same time as another", 1)));
  const auto images = only<CObservation3DRangeScan>(database.records);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_LT(secondsOf(*images[0]), secondsOf(*images[1]));
}

TEST(RtabmapImport, TruncatedFileGivesWhatCanBeRead) {
  const TemporaryFolder folder;
  std::vector<NodeRow> rows;
  for (int i = 1; i <= 60; ++i) {
    rows.push_back(smallNode(i, 1.7e9 + i));
    rows.back().image = encoded(cv::Mat(12, 16, CV_8UC3, cv::Scalar(i, i, i)), ".bmp");
  }
  writeDatabase(folder.file("x.db"), rows);
  const auto bytes = folder.read("x.db");
  const auto cut = folder.write("cut.db", bytes.substr(0, bytes.size() / 2));
  std::string told;
  try {
    const auto result = importRtabmap(cut, folder.file("y.rawlog"));
    ASSERT_FALSE(result.warnings.empty());
    told = result.warnings.front();
    EXPECT_GT(result.written.at("ODOMETRY"), 5);
  } catch (const InputError& error) {
    told = error.what();
  }
  EXPECT_THAT(told, HasSubstr("malformed"));
}

TEST(RtabmapImport, ImagesOutsideKeepTheDatabasesBytes) {
  auto row = smallNode();
  row.image = encoded(cv::Mat(12, 16, CV_8UC3, cv::Scalar(30, 60, 90)), ".jpg");
  const ImportedDatabase database({row}, {.external_images = true});
  const std::string file = "x_Images/RGBD_1700000000.000000_rgb.jpg";
  ASSERT_TRUE(std::filesystem::exists(database.folder.file(file)));
  EXPECT_EQ(database.folder.read(file), std::string(row.image.begin(), row.image.end()));
}

TEST(RtabmapImport, SensorsArePlacedByOptions) {
  const ImportedDatabase database({smallNode()}, {.sensor_poses = {{"RGBD", poseFromYpr(1, 2, 3, 0, 0, 0)}}});
  EXPECT_NEAR(only<CObservation3DRangeScan>(database.records).at(0)->sensorPose.z(), 3, 1e-9);
  EXPECT_THAT(messageOf<ConfigError>([] {
                ImportedDatabase({smallNode()}, {.sensor_poses = {{"KINECT", {}}}});
              }),
              HasSubstr("--pose KINECT: the sensors are RGBD and LASER"));
}

TEST(RtabmapImport, WhatIsNoDatabaseIsAnErrorInOneLine) {
  const TemporaryFolder folder;
  const auto error = [&](const std::filesystem::path& file) {
    return messageOf<InputError>([&] { importRtabmap(file, folder.file("y.rawlog")); });
  };
  EXPECT_THAT(error(folder.file("no.db")), HasSubstr("no such file"));
  EXPECT_THAT(error(folder.write("x.db", "This is a text of more than sixteen bytes.")),
              HasSubstr("x.db: is no database of RTAB-Map, or damaged"));
  EXPECT_THAT(error(folder.write("empty.db", "")), HasSubstr("is no database of RTAB-Map"));
  EXPECT_THAT(error(writeDatabase(folder.file("none.db"), {})), HasSubstr("none.db: has no nodes"));
  EXPECT_THAT(error(writeDatabase(folder.file("odd.db"), {}, "new")), HasSubstr("its version 'new' is none"));
  NodeRow nothing;
  EXPECT_THAT(error(writeDatabase(folder.file("nothing.db"), {nothing})),
              HasSubstr("no record can be made of it"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("y.rawlog")));
}

}  // namespace
}  // namespace roomgraph
