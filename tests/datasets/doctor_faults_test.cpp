// SPDX-License-Identifier: BSD-3-Clause
// Findings about sensors that fail while a recording goes on, each put in by hand, and none without a fault.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "odometry_statistics.h"
#include "rawlog_maker.h"
#include "repetition.h"
#include "roomgraph/core/random.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/observations/roughness.h"

namespace roomgraph {
namespace {

using namespace test;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

// A drive of 10 s along a wall: odometry at 10 Hz, scans and images at 5 Hz.
class DriveWithFaults : public testing::Test {
 protected:
  static constexpr int kReadings = 100;
  DriveWithFaults() {
    for (int i = 0; i < kReadings; ++i) {
      const double t = 100 + 0.1 * i;
      odometry.push_back(makeOdometry(t, 0.03 * i, 0, 0));
      if (i % 2 != 0) continue;
      scans.push_back(makeScan(t + 0.01, 2 + 0.03f * static_cast<float>(i)));
      images.push_back(makeImages(t + 0.02));
      images.back()->rangeImage(7, 7) = static_cast<std::uint16_t>(1000 + i);
    }
  }
  // In the order in which they were recorded: by the stamps before faults.
  std::vector<Finding> findings() {
    std::vector<Object> objects;
    for (std::size_t i = 0; i < odometry.size(); ++i) {
      if (odometry[i]) objects.push_back(odometry[i]);
      if (i % 2 == 0 && scans[i / 2]) objects.push_back(scans[i / 2]);
      if (i % 2 == 0 && images[i / 2]) objects.push_back(images[i / 2]);
    }
    writeRawlog(folder.file("x.rawlog"), objects);
    return inspectRawlog(folder.file("x.rawlog")).findings;
  }
  static auto warning(const std::string& place, const std::string& text) {
    return Contains(AllOf(Field(&Finding::severity, Severity::kWarning), Field(&Finding::place, place),
                          Field(&Finding::what, HasSubstr(text))));
  }
  TemporaryFolder folder;
  std::vector<mrpt::obs::CObservationOdometry::Ptr> odometry;
  std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;
  std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> images;
};

TEST_F(DriveWithFaults, NoneNoWarning) {
  EXPECT_THAT(findings(), Each(Field(&Finding::severity, Severity::kNote)));
}

TEST_F(DriveWithFaults, ClocksThatAreSetBackAreOneFindingAndReadersGoOn) {
  const auto setBack = [](auto& records, std::size_t from) {
    for (std::size_t i = from; i < records.size(); ++i)
      records[i]->timestamp = mrpt::Clock::fromDouble(mrpt::Clock::toDouble(records[i]->timestamp) - 2);
  };
  setBack(odometry, 50);
  setBack(scans, 25);
  setBack(images, 25);
  const auto found = findings();
  EXPECT_THAT(found, warning("all sensors", "their clock is set back by 2.00 s at t = 105.000 s"));
  EXPECT_THAT(found, Not(Contains(Field(&Finding::what, HasSubstr("older than")))));
  EXPECT_THAT(found, Not(Contains(Field(&Finding::what, HasSubstr("out of order")))));
  for (const bool continues : {true, false}) {
    RawlogReader reader(folder.file("x.rawlog"), {.continue_time = continues});
    int records = 0, older = 0;
    double last_t = 0;
    for (; const auto record = reader.next(); ++records) {
      older += timeOf(*record) < last_t;
      last_t = std::max(last_t, timeOf(*record));
    }
    EXPECT_EQ(records, 200);
    EXPECT_EQ(older > 0, !continues);
    EXPECT_EQ(reader.statistics().clocks_set_back.size(), continues ? 1u : 0u);
  }
}

TEST_F(DriveWithFaults, SilenceAtTheBeginningAndTheEnd) {
  for (std::size_t i = 60; i < odometry.size(); ++i) odometry[i] = nullptr;
  for (std::size_t i = 0; i < 12; ++i) scans[i] = nullptr;
  const auto found = findings();
  EXPECT_THAT(found, warning("ODOMETRY", "no record in the last 3.9 s of the recording"));
  EXPECT_THAT(found, warning("LASER", "no record in the first 2.4 s of the recording"));
}

TEST_F(DriveWithFaults, RepeatedStamps) {
  for (std::size_t i : {20u, 21u, 40u}) images[i]->timestamp = images[i - 1]->timestamp;
  EXPECT_THAT(findings(), warning("KINECT", "3 records have the time stamp of the one before"));
}

TEST_F(DriveWithFaults, FrozenImagesAndScans) {
  for (std::size_t i = 20; i < 30; ++i) {
    images[i]->rangeImage = images[19]->rangeImage;
    for (std::size_t k = 0; k < 5; ++k) scans[i]->setScanRange(k, scans[19]->getScanRange(k));
  }
  const auto found = findings();
  EXPECT_THAT(found, warning("KINECT", "11 images in a row are the same, for 2.0 s from t = 103.820 s"));
  EXPECT_THAT(found, warning("LASER", "11 scans in a row are the same, for 2.0 s from t = 103.810 s"));
}

// In a hall that is wider than the lidar reaches, all scans are alike.
TEST_F(DriveWithFaults, ScansWithoutReturnsDoNotHang) {
  for (std::size_t i = 20; i < 30; ++i)
    for (std::size_t k = 0; k < 5; ++k) {
      scans[i]->setScanRange(k, 0);
      scans[i]->setScanRangeValidity(k, false);
    }
  EXPECT_THAT(findings(), Not(Contains(Field(&Finding::what, HasSubstr("are the same")))));
  std::vector<Object> all;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (odometry[i]) all.push_back(odometry[i]);
    all.push_back(scans[i]);
  }
  writeRawlog(folder.file("hall.rawlog"), all);
  RawlogReader reader(folder.file("hall.rawlog"), {});
  while (reader.next()) {
  }
  EXPECT_TRUE(reader.statistics().skipped.empty());
}

TEST_F(DriveWithFaults, AFewEqualRecordsAreNoFault) {
  for (std::size_t i = 20; i < 24; ++i) images[i]->rangeImage = images[19]->rangeImage;
  EXPECT_THAT(findings(), Each(Field(&Finding::severity, Severity::kNote)));
}

TEST_F(DriveWithFaults, BlankPicturesAndEmptyDepth) {
  for (std::size_t i = 20; i < 23; ++i) {
    const cv::Mat white(12, 16, CV_8UC3, cv::Scalar(255, 255, 252));
    images[i]->intensityImage = mrpt::img::CImage(white, mrpt::img::DEEP_COPY);
  }
  images[40]->rangeImage.fill(0);
  const auto found = findings();
  EXPECT_THAT(found, warning("KINECT", "3 of 50 pictures show nothing; first at t = 104.020 s"));
  EXPECT_THAT(found, warning("KINECT", "1 of 50 depth images are empty; first at t = 108.020 s"));
}

TEST_F(DriveWithFaults, RangesThatAreNoNumbers) {
  scans[3]->setScanRange(2, std::numeric_limits<float>::quiet_NaN());
  scans[4]->setScanRange(2, std::numeric_limits<float>::infinity());
  scans[5]->setScanRange(2, std::numeric_limits<float>::infinity());
  scans[5]->setScanRangeValidity(2, false);  // how beams without return are often stored
  EXPECT_THAT(findings(), warning("LASER", "2 ranges are marked valid and are NaN or infinite"));
}

// Scans of 60 beams and images with a row for the median.
TEST_F(DriveWithFaults, BurstsOfNoise) {
  Random random(1);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i] = makeScan(100.01 + 0.2 * static_cast<double>(i), 2 + 0.06f * static_cast<float>(i), 60);
    images[i] = makeImages(100.02 + 0.2 * static_cast<double>(i), 80, 60);
    for (std::size_t k = 0; k < 60; ++k) {
      const double sigma = i >= 20 && i < 24 ? 0.3 : 0.01;
      scans[i]->setScanRange(k, scans[i]->getScanRange(k) + static_cast<float>(random.normal(0, sigma)));
    }
    for (auto& depth : images[i]->rangeImage)
      depth = static_cast<std::uint16_t>(depth + std::lround(random.normal(0, i >= 30 && i < 33 ? 100 : 5)));
  }
  const auto found = findings();
  EXPECT_THAT(found,
              warning("LASER", "4 of 50 scans are much noisier than the others; first at t = 104.010 s"));
  EXPECT_THAT(
      found,
      warning("KINECT", "3 of 50 depth images are much noisier than the others; first at t = 106.020 s"));
}

TEST_F(DriveWithFaults, WheelsThatStandWhileTheScansChange) {
  for (std::size_t i = 40; i < 80; ++i) odometry[i]->odometry.x(0.03 * 40);
  const auto found = findings();
  EXPECT_THAT(found,
              warning("ODOMETRY", "it stands still for 3.9 s from t = 104.000 s while the scans change"));
  EXPECT_THAT(found,
              warning("ODOMETRY", "1 jumps, the largest of 1.20 m and 0 deg; first after t = 107.900 s"));
}

TEST_F(DriveWithFaults, WheelsThatStandWithTheRobotAreNoFault) {
  for (std::size_t i = 40; i < 80; ++i) odometry[i]->odometry.x(0.03 * 40);
  for (std::size_t i = 80; i < 100; ++i) odometry[i]->odometry.x(0.03 * (i - 40.0));
  for (std::size_t i = 20; i < 50; ++i)
    for (std::size_t k = 0; k < 5; ++k)  // 1 mm of noise, then on as the robot does
      scans[i]->setScanRange(k, 3.2f + 0.001f * static_cast<float>(i) +
                                    (i < 40 ? 0.f : 0.06f * static_cast<float>(i - 40)) +
                                    0.1f * static_cast<float>(k));
  EXPECT_THAT(findings(), Each(Field(&Finding::severity, Severity::kNote)));
}

TEST_F(DriveWithFaults, AClockThatJumpsAgainstTheOthers) {
  for (std::size_t i = 25; i < images.size(); ++i) images[i]->timestamp += std::chrono::milliseconds(500);
  const auto found = findings();
  EXPECT_THAT(found,
              warning("KINECT", "its clock jumps by +0.50 s against that of ODOMETRY at t = 105.520 s"));
  EXPECT_THAT(found, Not(warning("LASER", "its clock")));
}

TEST_F(DriveWithFaults, AGapOfTheReferenceIsNoJumpOfTheOthersClocks) {
  for (std::size_t i = 30; i < 60; ++i) odometry[i] = nullptr;
  const auto found = findings();
  EXPECT_THAT(found, warning("ODOMETRY", "gap of 3.1 s"));
  EXPECT_THAT(found, Not(Contains(Field(&Finding::what, HasSubstr("clock")))));
}

TEST(Roughness, IsTheMedianSecondDifferenceOfBeamsThatReturn) {
  std::vector<float> ranges;
  for (int i = 0; i < 40; ++i) ranges.push_back(static_cast<float>(2 + 0.1 * i + 0.25 * (i % 2)));
  EXPECT_NEAR(roughnessOf(ranges), 0.5, 1e-6);
  for (std::size_t i = 0; i < ranges.size(); i += 5) ranges[i] = 0;
  EXPECT_EQ(roughnessOf(ranges), 0) << "too few neighbours to tell";
  EXPECT_EQ(roughnessOf({}), 0);
  // Half of what a scan sees may be chair legs.
  std::vector<float> scan(100, 2.f);
  for (std::size_t i = 0; i < 60; i += 2) scan[i] = 3;
  EXPECT_EQ(roughnessOfScan(scan), 0);
  EXPECT_GT(roughnessOf(scan), 1);
}

TEST(Roughness, OfNormalNoiseIsThatOfASumOfThree) {
  Random random(5);
  std::vector<float> ranges(100001);
  for (auto& range : ranges) range = static_cast<float>(10 + random.normal(0, 0.2));
  // a - 2 b + c has the variance 6; half of a normal distribution lies within 0.6745 of its sigma.
  EXPECT_NEAR(roughnessOf(ranges), 0.6745 * std::sqrt(6.0) * 0.2, 0.005);
  EXPECT_NEAR(roughnessOfScan(ranges), 0.6745 * std::sqrt(6.0) * 0.2, 0.01) << "likewise";
}

TEST(Repetition, FindsTheLongestRunByTime) {
  Repetition repetition;
  const std::vector<std::pair<double, std::string>> records{{1, "a"}, {2, "a"}, {3, "b"}, {4, "c"},
                                                            {7, "c"}, {8, "c"}, {9, "a"}};
  for (const auto& [t, content] : records) repetition.add(t, content);
  EXPECT_EQ(repetition.longest().records, 3);
  EXPECT_EQ(repetition.longest().from, 4);
  EXPECT_EQ(repetition.longest().seconds, 4);
}

TEST(HangingSensor, OfOneThatKeptChangingFromTheSecondRecordOnOnceTheWheelsHaveTurned) {
  HangingSensor sensor;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(sensor.hangs(i - 10, std::to_string(i), Pose2{}));
  std::vector<bool> hangs;
  for (int i = 0; i < 6; ++i) hangs.push_back(sensor.hangs(i, "a", Pose2{0.1 * i, 0, 0}));
  hangs.push_back(sensor.hangs(6, "b", Pose2{0.6, 0, 0}));
  EXPECT_EQ(hangs, (std::vector<bool>{false, true, true, true, true, true, false}));
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(sensor.hangs(7, "c", Pose2{0.7 + 0.1 * i, 0, 0})) << "one stamp";
  HangingSensor turning, unknown;
  for (int i = 0; i < 5; ++i) turning.hangs(i - 10, std::to_string(i), Pose2{0, 0, 3.13});
  for (int i = 0; i < 6; ++i) EXPECT_EQ(unknown.hangs(i, "a", Pose2{0.1 * i, 0, 0}), i > 3) << "it may be one without noise";
  for (int i = 0; i < 6; ++i) EXPECT_EQ(turning.hangs(i, "a", Pose2{0, 0, 3.13 + 0.008 * i}), i > 2);
}

TEST(HangingSensor, ARobotThatStandsIsSeenTheSame) {
  HangingSensor sensor, blind;
  for (int i = 0; i < 9; ++i) {
    EXPECT_FALSE(sensor.hangs(i, "a", Pose2{1, 2, 0.001 * i}));
    EXPECT_FALSE(blind.hangs(i, "a", std::nullopt)) << "no wheels say that it moves";
  }
}

TEST(HangingSensor, WithoutWheelsOneThatNeverRepeatedItself) {
  HangingSensor sensor, young;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(sensor.hangs(i - 30, std::to_string(i), std::nullopt));
  for (int i = 0; i < 19; ++i) young.hangs(i - 30, std::to_string(i), std::nullopt);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(sensor.hangs(i, "a", std::nullopt), i > 0);
    EXPECT_FALSE(young.hangs(i, "a", std::nullopt));
  }
}

TEST(Repetition, ContentIsWhatWasMeasured) {
  auto scan = makeScan(1), other = makeScan(2);
  EXPECT_EQ(contentOf(*scan), contentOf(*other));
  other->setScanRangeValidity(3, false);
  EXPECT_NE(contentOf(*scan), contentOf(*other));
  auto images = makeImages(1), others = makeImages(2);
  EXPECT_EQ(contentOf(*images), contentOf(*others));
  others->rangeImage(7, 14) = 5;
  EXPECT_NE(contentOf(*images), contentOf(*others));
  others = makeImages(2);
  others->intensityImage.setPixel(14, 7, mrpt::img::TColor(1, 2, 3));
  EXPECT_NE(contentOf(*images), contentOf(*others));
}

TEST_F(DriveWithFaults, AReaderLeavesOutWhatASensorThatHangsRepeats) {
  for (std::size_t i = 20; i < 30; ++i) {
    images[i]->rangeImage = images[19]->rangeImage;
    for (std::size_t k = 0; k < 5; ++k) scans[i]->setScanRange(k, scans[19]->getScanRange(k));
  }
  findings();
  RawlogReader reader(folder.file("x.rawlog"));
  std::vector<double> times;
  while (const auto record = reader.next())
    if (std::holds_alternative<Scan>(*record)) times.push_back(timeOf(*record));
  EXPECT_EQ(times.size(), 40u);
  EXPECT_EQ(std::count_if(times.begin(), times.end(), [](double t) { return t > 103.9 && t < 105.9; }), 0);
  const auto& statistics = reader.statistics();
  for (const std::string name : {"CObservation2DRangeScan", "CObservation3DRangeScan"}) {
    EXPECT_EQ(statistics.used.at(name), 40);
    EXPECT_EQ(statistics.skipped.at(name + ": the same as those before it while the wheels turned, the sensor hangs"), 10);
  }
}

TEST(OdometryStatistics, PathTurnsAndWhatNoRobotCanDo) {
  OdometryStatistics statistics;
  statistics.add(0, {0, 0, 0});
  statistics.add(0.1, {0.3, 0.4, 0});  // 0.5 m in 0.1 s
  statistics.add(1.1, {0.3, 2.4, 0});  // 2 m in 1 s: fast, and possible
  statistics.add(1.2, {0.3, 2.4, 1});  // 1 rad in 0.1 s
  statistics.add(1.3, {0.3, 2.4, 1 - 2 * M_PI});
  const auto report = statistics.report();
  EXPECT_NEAR(report.path_length_m, 2.5, 1e-12);
  EXPECT_NEAR(report.turn_rad, 1, 1e-12);
  EXPECT_EQ(report.jumps, 2);
  EXPECT_EQ(report.first_jump_time, 0);
  EXPECT_NEAR(report.largest_jump_m, 0.5, 1e-12);
  EXPECT_NEAR(report.largest_jump_rad, 1, 1e-12);
}

TEST(OdometryStatistics, StandstillsThatLast) {
  OdometryStatistics statistics;
  for (int i = 0; i <= 10; ++i) statistics.add(i, {std::min(i, 3) * 1.0, 0, 0});
  statistics.add(11, {4, 0, 0});
  statistics.add(12, {4, 0, 0});  // too short
  const auto found = statistics.standstills();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].from, 3);
  EXPECT_EQ(found[0].seconds, 7);
}

}  // namespace
}  // namespace roomgraph
