// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs written as bags and TUM folders and read again: the same records; and what Debian's rosbag sees in
// them.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "bag_maker.h"
#include "errors_of.h"
#include "roomgraph/bags/bag_export.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/truth_file.h"
#include "roomgraph/datasets/tum_export.h"
#include "roomgraph/datasets/tum_import.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/rawlog_writer.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

const std::filesystem::path kRawlogs = ROOMGRAPH_SOURCE_DIR "/rawlogs";

bool samePixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

void expectSame(const Record& a, const Record& b) {
  ASSERT_EQ(a.index(), b.index());
  EXPECT_DOUBLE_EQ(timeOf(a), timeOf(b));
  if (const auto* frame = std::get_if<Frame>(&a)) {
    const auto& other = std::get<Frame>(b);
    EXPECT_TRUE(samePixels(frame->color, other.color));
    EXPECT_TRUE(samePixels(frame->depth, other.depth));
    EXPECT_EQ(frame->camera, other.camera);
    EXPECT_TRUE(frame->robot_from_camera.isApprox(other.robot_from_camera, 1e-9));
    EXPECT_EQ(frame->sensor_label, other.sensor_label);
  } else if (const auto* scan = std::get_if<Scan>(&a)) {
    const auto& other = std::get<Scan>(b);
    EXPECT_EQ(scan->valid, other.valid);
    EXPECT_EQ(scan->angle_min_rad, other.angle_min_rad);
    EXPECT_EQ(scan->angle_step_rad, other.angle_step_rad);
    EXPECT_EQ(scan->max_range_m, other.max_range_m);
    EXPECT_TRUE(scan->robot_from_lidar.isApprox(other.robot_from_lidar, 1e-9));
    EXPECT_EQ(scan->sensor_label, other.sensor_label);
    ASSERT_EQ(scan->ranges_m.size(), other.ranges_m.size());
    for (std::size_t i = 0; i < scan->ranges_m.size(); ++i)
      EXPECT_EQ(scan->valid[i] ? scan->ranges_m[i] : 0, scan->valid[i] ? other.ranges_m[i] : 0);
  } else if (const auto* wheels = std::get_if<OdometryReading>(&a)) {
    const auto& other = std::get<OdometryReading>(b);
    EXPECT_DOUBLE_EQ(wheels->odom_from_robot.x, other.odom_from_robot.x);
    EXPECT_NEAR(wheels->odom_from_robot.yaw, other.odom_from_robot.yaw, 1e-12);
  }
}

/// All records of both, sorted by time as a bag has them. Returns their number.
int expectSameRawlogs(const std::filesystem::path& first, const std::filesystem::path& second) {
  const auto all = [](const std::filesystem::path& file) {
    std::vector<Record> records;
    RawlogReader reader(file);
    while (auto record = reader.next())
      if (!std::holds_alternative<std::shared_ptr<CObservationDetections>>(*record))
        records.push_back(std::move(*record));
    std::stable_sort(records.begin(), records.end(), [](const Record& a, const Record& b) {
      return std::pair(timeOf(a), a.index()) < std::pair(timeOf(b), b.index());
    });
    return records;
  };
  const auto a = all(first), b = all(second);
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) expectSame(a[i], b[i]);
  return static_cast<int>(a.size());
}

TEST(BagRoundTrip, RobotAndHandheldRecordings) {
  for (const char* name : {"tiny_room.rawlog", "tiny_handheld.rawlog"}) {
    const TemporaryFolder folder;
    exportRecording(kRawlogs / name, folder.file("x.bag"));
    const auto result = importBag(folder.file("x.bag"), folder.file("x.rawlog"));
    EXPECT_THAT(result.warnings, IsEmpty()) << name;
    EXPECT_GT(expectSameRawlogs(kRawlogs / name, folder.file("x.rawlog")), 2) << name;
  }
}

// Of everything that a rawlog may hold and the shipped ones do not.
mrpt::obs::CObservation3DRangeScan::Ptr makeImages(double t, double pitch) {
  auto images = CObservation3DRangeScan::Create();
  images->timestamp = mrpt::Clock::fromDouble(t);
  images->sensorLabel = "HEAD";
  images->hasRangeImage = images->hasIntensityImage = images->range_is_depth = true;
  images->rangeUnits = 0.0002f;
  images->rangeImage_setSize(12, 16);
  images->intensityImage.resize(16, 12, mrpt::img::CH_RGB);
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 16; ++u) {
      images->rangeImage(v, u) = static_cast<std::uint16_t>(5001 + 317 * u + v);
      images->intensityImage.setPixel(
          u, v, mrpt::img::TColor(static_cast<std::uint8_t>(10 * u), static_cast<std::uint8_t>(7 * v), 99));
    }
  images->cameraParams.ncols = 16;
  images->cameraParams.nrows = 12;
  images->cameraParams.setIntrinsicParamsFromValues(20, 21, 7.5, 5.5);
  images->cameraParamsIntensity = images->cameraParams;
  images->cameraParamsIntensity.setDistortionPlumbBob(0.01, 0.02, 0.001, 0.002, 0);
  images->sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.9, 0.3, pitch, 0);
  images->relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, -0.025, 0, -M_PI / 2, 0, -M_PI / 2);
  return images;
}

std::vector<mrpt::obs::CObservation::Ptr> oddRecords() {
  std::vector<mrpt::obs::CObservation::Ptr> records;
  for (int k = 0; k < 30; ++k) {
    const double t = kStart_s + 0.1 * k;
    records.push_back(makeImages(t, k < 20 ? 0.1 : 0.1 + 0.01 * k));  // a head that begins to nod
    auto scan = CObservation2DRangeScan::Create();
    scan->timestamp = mrpt::Clock::fromDouble(t + 0.02);
    scan->sensorLabel = "rear_link";
    scan->aperture = 3;
    scan->rightToLeft = false;
    scan->maxRange = 5;
    scan->sensorPose = mrpt::poses::CPose3D(-0.2, 0, 0.3, M_PI, 0, 0);
    scan->resizeScan(7);
    for (std::size_t i = 0; i < 7; ++i) {
      scan->setScanRange(i, 1 + 0.3f * static_cast<float>(i));
      scan->setScanRangeValidity(i, i != 4);
    }
    records.push_back(scan);
    auto imu = CObservationIMU::Create();
    imu->timestamp = mrpt::Clock::fromDouble(t + 0.05);
    imu->sensorLabel = "IMU";
    imu->set(mrpt::obs::IMU_WX, 0.5 * k);
    imu->set(mrpt::obs::IMU_WY, 2);
    imu->set(mrpt::obs::IMU_WZ, 3);
    imu->sensorPose = mrpt::poses::CPose3D(0.1, 0, 0, 0, 0, 0);
    records.push_back(imu);
  }
  return records;
}

TEST(BagRoundTrip, MovingUnregisteredDistortedAndClockwise) {
  const TemporaryFolder folder;
  RawlogWriter writer(folder.file("in.rawlog"));
  for (const auto& record : oddRecords()) writer.write(*record);
  writer.finish();
  const auto exported = exportRecording(folder.file("in.rawlog"), folder.file("x.bag"));
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("frame 'HEAD_optical_frame' moves on the robot")));
  const auto imported = importBag(folder.file("x.bag"), folder.file("out.rawlog"));
  EXPECT_THAT(imported.skipped, IsEmpty());
  const auto in = recordsIn(folder.file("in.rawlog")), out = recordsIn(folder.file("out.rawlog"));
  const auto images_in = only<CObservation3DRangeScan>(in), images_out = only<CObservation3DRangeScan>(out);
  ASSERT_EQ(images_in.size(), images_out.size());
  for (std::size_t i = 0; i < images_in.size(); ++i) {
    EXPECT_EQ(images_in[i]->timestamp, images_out[i]->timestamp);
    EXPECT_TRUE(images_in[i]->rangeImage == images_out[i]->rangeImage);
    EXPECT_EQ(images_in[i]->rangeUnits, images_out[i]->rangeUnits);
    EXPECT_EQ(images_in[i]->cameraParamsIntensity.p2(), images_out[i]->cameraParamsIntensity.p2());
    EXPECT_TRUE(toPose3(images_in[i]->sensorPose).isApprox(toPose3(images_out[i]->sensorPose), 1e-9)) << i;
    EXPECT_TRUE(toPose3(images_in[i]->relativePoseIntensityWRTDepth)
                    .isApprox(toPose3(images_out[i]->relativePoseIntensityWRTDepth), 1e-9));
  }
  const auto imus_in = only<CObservationIMU>(in), imus_out = only<CObservationIMU>(out);
  ASSERT_EQ(imus_in.size(), imus_out.size());
  for (std::size_t i = 0; i < imus_in.size(); ++i) {
    EXPECT_EQ(imus_in[i]->rawMeasurements, imus_out[i]->rawMeasurements);
    EXPECT_EQ(imus_in[i]->dataIsPresent, imus_out[i]->dataIsPresent);
  }
  EXPECT_EQ(expectSameRawlogs(folder.file("in.rawlog"), folder.file("out.rawlog")), 60);
}

TEST(BagRoundTrip, GroundTruthBesideTheRawlog) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(kRawlogs / "tiny_handheld.rawlog", folder.file("in.rawlog"));
  const double t = secondsOf(*recordsIn(folder.file("in.rawlog")).front());
  char line[100];
  std::snprintf(line, sizeof line, "%.9f 1 2 3 0 0 0 1\n", t + 0.01);
  folder.write("in.groundtruth.txt", line);
  exportRecording(folder.file("in.rawlog"), folder.file("x.bag"));
  const auto result = importBag(folder.file("x.bag"), folder.file("out.rawlog"));
  EXPECT_EQ(result.truth, "/ground_truth");
  EXPECT_EQ(folder.read("out.groundtruth.txt"), truthComment(TruthOf::kCamera) + line);
}

// read_bag.py compares types, checksums and definitions with Debian's message packages, and looks each
// message up by the index.
TEST(BagWriter, DebianReadsWhatIsWritten) {
  const TemporaryFolder folder;
  RawlogWriter writer(folder.file("in.rawlog"));
  for (const auto& record : oddRecords()) writer.write(*record);
  writer.finish();
  exportRecording(folder.file("in.rawlog"), folder.file("x.bag"));
  runPython("read_bag.py", "recording '" + folder.file("x.bag").string() + "'");
  exportResult(kRawlogs / "tiny_room.rgmap", folder.file("map.bag"));
  const auto map = loadMap(kRawlogs / "tiny_room.rgmap");
  saveLandmarksJson(map.landmarks, folder.file("landmarks.json"));
  ASSERT_TRUE(map.occupancy);
  saveOccupancyRos(*map.occupancy, folder.file("map"));
  runPython("read_bag.py", "map '" + folder.file("map.bag").string() + "' '" + folder.path().string() + "' " +
                               std::to_string(map.world_from_robot.size()));
}

TEST(BagWriter, InputsAreKeptAndNothingIsLeftBehind) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(kRawlogs / "tiny_room.rawlog", folder.file("in.rawlog"));
  EXPECT_THAT(
      messageOf<ConfigError>([&] { exportRecording(folder.file("in.rawlog"), folder.file("in.rawlog")); }),
      HasSubstr("in.rawlog"));
  EXPECT_THROW(exportRecording(folder.file("none.rawlog"), folder.file("x.bag")), InputError);
  EXPECT_THROW(exportRecording(folder.file("in.rawlog"), folder.file("x.bag"),
                               [](double) { throw Interrupted("stop"); }),
               Interrupted);
  EXPECT_THROW(exportResult(folder.path(), folder.file("x.bag")), InputError);
  EXPECT_EQ(folder.count(), 1u);
}

TEST(TumRoundTrip, TheSameRecordsAndOddCameras) {
  for (const char* name : {"tiny_room.rawlog", "tiny_handheld.rawlog"}) {
    const TemporaryFolder folder;
    const auto exported = exportTum(kRawlogs / name, folder.file("tum"));
    EXPECT_EQ(exported.registered, 0);
    const TumImportOptions options{.label = exported.label, .robot_from_sensor = exported.robot_from_camera};
    EXPECT_EQ(importTum(folder.file("tum"), folder.file("x.rawlog"), options).written, exported.written);
    RawlogReader before(kRawlogs / name, {.scans = false, .odometry = false}), after(folder.file("x.rawlog"));
    int frames = 0;
    for (auto record = before.next(); record; record = before.next()) {
      if (!std::holds_alternative<Frame>(*record)) continue;
      const auto other = after.next();
      ASSERT_TRUE(other);
      EXPECT_NEAR(timeOf(*record), timeOf(*other), 3e-7);
      EXPECT_TRUE(samePixels(std::get<Frame>(*record).color, std::get<Frame>(*other).color));
      EXPECT_TRUE(samePixels(std::get<Frame>(*record).depth, std::get<Frame>(*other).depth));
      EXPECT_EQ(std::get<Frame>(*record).camera, std::get<Frame>(*other).camera);
      EXPECT_TRUE(std::get<Frame>(*record).robot_from_camera.isApprox(
          std::get<Frame>(*other).robot_from_camera, 1e-9));
      ++frames;
    }
    EXPECT_EQ(frames, exported.written);
  }
}

TEST(TumExport, DepthOfAnotherCameraIsProjected) {
  const TemporaryFolder folder;
  RawlogWriter writer(folder.file("in.rawlog"));
  for (const auto& record : oddRecords()) writer.write(*record);
  writer.finish();
  folder.write("in.groundtruth.txt", truthComment(TruthOf::kCamera) + "1 0 0 0 0 0 0 1\n");
  const auto exported = exportTum(folder.file("in.rawlog"), folder.file("tum"));
  EXPECT_EQ(exported.registered, 30);
  EXPECT_TRUE(exported.ground_truth);
  importTum(folder.file("tum"), folder.file("x.rawlog"));
  RawlogReader before(folder.file("in.rawlog"), {.scans = false}), after(folder.file("x.rawlog"));
  const auto a = std::get<Frame>(*before.next()), b = std::get<Frame>(*after.next());
  EXPECT_TRUE(samePixels(a.color, b.color));
  EXPECT_LT(cv::norm(a.depth, b.depth, cv::NORM_INF), 1.01e-4) << "half a unit of 0.2 mm";
  Pose3 optical = exported.robot_from_camera;
  optical.linear() = optical.linear() * bodyFromOptical();
  EXPECT_TRUE(optical.isApprox(a.robot_from_camera, 1e-9)) << "that of the colour camera, whose pixels both images have";
}

TEST(TumExport, BadUseIsToldAndLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      messageOf<ConfigError>([&] { exportTum(kRawlogs / "tiny_room.rawlog", folder.file("tum"), "EYE"); }),
      HasSubstr("no RGB-D camera 'EYE'; there is: '"));
  EXPECT_THROW(exportTum(kRawlogs / "tiny_room.rawlog", folder.file("tum"), "",
                         [](double) { throw Interrupted("stop"); }),
               Interrupted);
  EXPECT_EQ(folder.count(), 0u);
  folder.write("full", "");
  EXPECT_THAT(messageOf<ConfigError>([&] { exportTum(kRawlogs / "tiny_room.rawlog", folder.path()); }),
              HasSubstr("not an empty folder"));
}

}  // namespace
}  // namespace roomgraph
