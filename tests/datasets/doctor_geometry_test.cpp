// SPDX-License-Identifier: BSD-3-Clause
// Report about a recording: depth unit and sensor pose against floor and lidar, on real data too.
#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>

#include <cmath>

#include "data_folder.h"
#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

::testing::Matcher<Finding> finding(Severity severity, const std::string& text) {
  return AllOf(Field(&Finding::severity, severity), Field(&Finding::what, HasSubstr(text)));
}
const auto kNoWorseThanNotes = Each(Field(&Finding::severity, Severity::kNote));

// A room of 6 x 6 m around the robot, as the ray from a point (robot frame, z up) meets it, m.
double distanceToRoom(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double nearest = ray.z() < 0 ? -from.z() / ray.z() : 1e9;
  for (const int axis : {0, 1}) {
    const double wall = ray[axis] > 0 ? 3 : -3;
    if (ray[axis] != 0) nearest = std::min(nearest, (wall - from[axis]) / ray[axis]);
  }
  return nearest;
}

constexpr double kHeight_m = 0.8, kPitch_rad = 0.2;

// No two records of a real sensor are the same.
int flicker(double t) {
  return static_cast<int>(std::lround(10 * t)) % 2;
}

/// Depth image of the room from a camera 0.8 m above the floor that looks down a little; in millimetres.
mrpt::obs::CObservation3DRangeScan::Ptr roomImages(double t, bool along_rays = false) {
  auto images = makeImages(t, 64, 48);
  images->hasIntensityImage = false;
  images->cameraParams.setIntrinsicParamsFromValues(55, 55, 31.5, 23.5);
  images->range_is_depth = !along_rays;
  images->sensorPose = mrpt::poses::CPose3D(0, 0, kHeight_m, 0, kPitch_rad, 0);
  const Pose3 pose = toPose3(images->sensorPose);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const Eigen::Vector3d ray(1, -(u - 31.5) / 55, -(v - 23.5) / 55);
      const double depth = distanceToRoom(pose.translation(), pose.linear() * ray);
      const double range = along_rays ? depth * ray.norm() : depth;
      images->rangeImage(v, u) = static_cast<std::uint16_t>(std::lround(1000 * range));
    }
  images->rangeImage(0, 0) += static_cast<std::uint16_t>(flicker(t));
  return images;
}

mrpt::obs::CObservation2DRangeScan::Ptr roomScan(double t) {
  auto scan = makeScan(t, 2, 181);
  scan->aperture = static_cast<float>(M_PI);
  for (int i = 0; i < 181; ++i) {
    const double angle = (i - 90) * M_PI / 180;
    const Eigen::Vector3d ray(std::cos(angle), std::sin(angle), 0);
    scan->setScanRange(static_cast<std::size_t>(i), static_cast<float>(distanceToRoom({0, 0, 0.25}, ray)));
  }
  scan->setScanRange(0, scan->getScanRange(0) + 0.001F * static_cast<float>(flicker(t)));
  return scan;
}

class DoctorGeometry : public ::testing::Test {
 protected:
  /// Images of a robot in the room, changed by `change`, with odometry and, if wanted, scans.
  template <class Change>
  RawlogReport inspect(bool scans, const Change& change, bool odometry = true, int count = 40) {
    std::vector<Object> objects;
    for (int i = 0; i < count; ++i) {
      if (odometry) objects.push_back(makeOdometry(0.1 * i, 0, 0, 0));
      if (scans) objects.push_back(roomScan(0.1 * i + 0.02));
      const auto images = roomImages(0.1 * i + 0.05);
      change(*images);
      objects.push_back(images);
    }
    writeRawlog(folder_.file("x.rawlog"), objects);
    return inspectRawlog(folder_.file("x.rawlog"));
  }
  static const ImageSummary& imagesOf(const RawlogReport& report) {
    return *std::find_if(report.sensors.begin(), report.sensors.end(), [](const SensorReport& s) {
              return s.images.has_value();
            })->images;
  }
  TemporaryFolder folder_;
};

using Images = mrpt::obs::CObservation3DRangeScan;

TEST_F(DoctorGeometry, FloorAndLidarAgreeWithAGoodRecording) {
  const auto report = inspect(true, [](Images&) {});
  const auto& images = imagesOf(report);
  ASSERT_TRUE(images.floor);
  EXPECT_NEAR(images.floor->sensor_height_m, kHeight_m, 0.01);
  EXPECT_LT(images.floor->tilt_rad, 0.01);
  ASSERT_TRUE(images.range_over_lidar);
  EXPECT_NEAR(*images.range_over_lidar, 1, 0.03);
  EXPECT_THAT(report.findings, kNoWorseThanNotes);
}

TEST_F(DoctorGeometry, RangesAlongTheRayGiveTheSameFloor) {
  const auto report = inspect(
      false, [](Images& images) { images = *roomImages(mrpt::Clock::toDouble(images.timestamp), true); });
  ASSERT_TRUE(imagesOf(report).floor);
  EXPECT_NEAR(imagesOf(report).floor->sensor_height_m, kHeight_m, 0.01);
  EXPECT_LT(imagesOf(report).floor->tilt_rad, 0.01);
}

TEST_F(DoctorGeometry, WrongDepthUnitIsFoundByTheLidarElseByTheFloor) {
  for (const float factor : {5.f, 0.2f}) {
    const auto wrong = [&](Images& images) { images.rangeUnits *= factor; };
    const std::string text = factor > 1 ? "5" : "0.2";
    EXPECT_THAT(inspect(true, wrong).findings,
                Contains(finding(Severity::kError, "walls " + text + " times as far away as the lidar")));
    EXPECT_THAT(inspect(false, wrong).findings,
                Contains(finding(Severity::kWarning, "is wrong by a factor of " + text)));
    EXPECT_THAT(inspect(true, wrong).findings,
                Not(Contains(finding(Severity::kWarning, "the floor is seen"))))
        << "the pose is not to blame";
  }
}

TEST_F(DoctorGeometry, WrongDepthUnitWithoutAnythingToCompareIsFoundByTheRanges) {
  const auto scaled = [](float factor) {
    return [factor](Images& images) {
      images.rangeUnits *= factor;
      images.sensorPose = {};
    };
  };
  EXPECT_THAT(inspect(false, scaled(1), false).findings, kNoWorseThanNotes);
  EXPECT_THAT(inspect(false, scaled(5), false).findings,
              Contains(finding(Severity::kWarning, "may be too large")));
  EXPECT_THAT(inspect(false, scaled(0.15f), false).findings,
              Contains(finding(Severity::kWarning, "may be too small")));
}

TEST_F(DoctorGeometry, PoseThatPutsTheFloorElsewhereIsFoundAndMended) {
  const std::vector<mrpt::poses::CPose3D> wrong = {
      {0.3, 0, kHeight_m, 0, 0, 0},                   // level
      {0.3, 0, 1.3, 0, kPitch_rad, 0},                // too high
      {0, 0, 0, 0, 0, 0},                             // never set
      {0.3, 0, kHeight_m, -M_PI / 2, 0, -M_PI / 2}};  // of the optical frame
  for (const auto& pose : wrong) {
    const auto report = inspect(false, [&](Images& images) { images.sensorPose = pose; });
    EXPECT_THAT(report.findings,
                Contains(AllOf(finding(Severity::kWarning, "the floor is seen 0.80 m below the sensor"),
                               Field(&Finding::hint, HasSubstr("--pose KINECT=")))))
        << pose;
    const Pose3 fit = imagesOf(report).floor->fitting_pose;
    const auto mended = inspectRawlog(folder_.file("x.rawlog"), nullptr, {{"KINECT", fit}});
    EXPECT_THAT(mended.findings, kNoWorseThanNotes) << pose;
  }
}

TEST_F(DoctorGeometry, WallsThatCameraAndLidarSeeInDifferentPlacesAreFound) {
  const auto inspectWith = [&](const mrpt::poses::CPose3D& camera) {
    std::vector<Object> objects;
    for (int i = 0; i < 40; ++i) {
      const auto scan = roomScan(0.1 * i + 0.02);
      scan->sensorPose = mrpt::poses::CPose3D(0, 0, 0.25, 0, 0, 0);
      const auto images = roomImages(0.1 * i + 0.05);
      images->sensorPose = camera;
      objects.insert(objects.end(), {makeOdometry(0.1 * i, 0, 0, 0), scan, images});
    }
    writeRawlog(folder_.file("x.rawlog"), objects);
    return inspectRawlog(folder_.file("x.rawlog"));
  };
  const auto good = inspectWith({0, 0, kHeight_m, 0, kPitch_rad, 0});
  ASSERT_TRUE(imagesOf(good).walls_off_m);
  EXPECT_LT(*imagesOf(good).walls_off_m, 0.02);
  EXPECT_THAT(good.findings, kNoWorseThanNotes);
  const auto moved = inspectWith({0.12, 0, kHeight_m, 0, kPitch_rad, 0});
  EXPECT_NEAR(imagesOf(moved).walls_off_m.value_or(0), 0.12, 0.03);
  EXPECT_THAT(moved.findings,
              Contains(AllOf(finding(Severity::kWarning, "walls in the depth images lie 0.1"),
                             Field(&Finding::hint, HasSubstr("roomgraph calibrate")))));
}

TEST_F(DoctorGeometry, SmallErrorsOfThePoseAreNoFindings) {
  const auto report = inspect(false, [](Images& images) {
    images.sensorPose = mrpt::poses::CPose3D(0, 0, kHeight_m + 0.03, 0, kPitch_rad + 0.025, 0.02);
  });
  EXPECT_THAT(report.findings, kNoWorseThanNotes);
}

TEST_F(DoctorGeometry, SwayingHandHasNoFloorAtOnePlace) {
  int i = 0;
  const auto report = inspect(
      false,
      [&](Images& images) {
        images.rangeUnits *= 1 + 0.1f * static_cast<float>(i++ % 8);  // now higher, now lower
        images.sensorPose = {};
      },
      false);
  EXPECT_FALSE(imagesOf(report).floor);
  EXPECT_THAT(report.findings, kNoWorseThanNotes);
}

TEST_F(DoctorGeometry, SwayingCameraWithAHeightIsNotOnARobot) {
  for (const bool on_robot : {false, true}) {
    int i = 0;
    const auto report = inspect(
        on_robot, [&](Images& images) { images.rangeUnits *= 1 + 0.1f * static_cast<float>(i++ % 8); }, on_robot);
    const auto by_hand = AllOf(finding(Severity::kWarning, "now higher, now lower: by 0.16 m"),
                               Field(&Finding::hint, HasSubstr("--pose KINECT=0,0,0,0,0,0")));
    if (on_robot) {
      EXPECT_THAT(report.findings, Not(Contains(Field(&Finding::hint, HasSubstr("by hand")))));
    } else {
      EXPECT_THAT(report.findings, Contains(by_hand));
    }
  }
}

TEST_F(DoctorGeometry, FloorInFewImagesIsNoFloor) {
  for (const int with_floor : {40, 60}) {  // a quarter must show it
    int i = 0;
    const auto report = inspect(
        false,
        [&](Images& images) {
          images.sensorPose = {0.3,       0, kHeight_m,
                               -M_PI / 2, 0, -M_PI / 2};               // no floor where this pose expects it
          if (i++ >= with_floor) images.rangeImage.setConstant(2000);  // a wall
        },
        true, 200);
    EXPECT_EQ(imagesOf(report).floor.has_value(), with_floor == 60) << with_floor << " of 200";
  }
}

// The recordings at hand are well, and are not when the unit of their depths is wrong.
// -----------------------

std::vector<Object> recordsOf(const std::filesystem::path& file, std::size_t most, float unit_factor) {
  std::vector<Object> objects;
  mrpt::io::CFileGZInputStream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  try {
    while (objects.size() < most) {
      objects.push_back(archive.ReadObject());
      if (const auto images = std::dynamic_pointer_cast<Images>(objects.back()))
        images->rangeUnits *= unit_factor;
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // The end of the recording.
  }
  return objects;
}

class DoctorOnRecordings : public ::testing::TestWithParam<std::string> {};

TEST_P(DoctorOnRecordings, WrongDepthUnitIsFoundAndTheRightOneIsNot) {
  const auto file = GetParam() == "lab_a"
                        ? dataFolder() / "lab/lab_a/lab_a.rawlog"
                        : std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / (GetParam() + ".rawlog");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "missing: " << file;
  TemporaryFolder folder;
  for (const float factor : {1.f, 5.f, 0.2f}) {
    writeRawlog(folder.file("x.rawlog"), recordsOf(file, 400, factor), false);
    const auto findings = inspectRawlog(folder.file("x.rawlog")).findings;
    if (factor == 1)
      EXPECT_THAT(findings, kNoWorseThanNotes);
    else
      EXPECT_THAT(findings, Contains(AllOf(Field(&Finding::severity, ::testing::Ge(Severity::kWarning)),
                                           Field(&Finding::what, HasSubstr("the depth unit")))))
          << factor;
  }
}
INSTANTIATE_TEST_SUITE_P(Recordings, DoctorOnRecordings,
                         ::testing::Values("tiny_room", "tiny_handheld", "lab_a"),
                         [](const auto& recording) { return recording.param; });

}  // namespace
}  // namespace roomgraph
