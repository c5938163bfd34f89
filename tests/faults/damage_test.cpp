// SPDX-License-Identifier: BSD-3-Clause
// Whole recordings through faults: untouched bytes, order of faults, formats, seeds, errors.
#include "roomgraph/faults/damage.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "../datasets/rawlog_maker.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/stored_observations.h"

namespace roomgraph {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Damage : public ::testing::Test {
 protected:
  DamageResult damage(const std::vector<FaultRequest>& requests, std::uint64_t seed = 1) {
    return damageRawlog(in, out, requests, seed);
  }
  std::vector<StoredObservation> read() const {
    StoredObservationReader reader(out);
    std::vector<StoredObservation> all;
    while (auto next = reader.next()) all.push_back(std::move(*next));
    EXPECT_EQ(reader.truncation(), "");
    EXPECT_TRUE(reader.skipped().empty());
    return all;
  }
  std::vector<double> stamps() const {
    std::vector<double> out_stamps;
    for (const auto& stored : read())
      out_stamps.push_back(std::round(1e3 * mrpt::Clock::toDouble(stored.observation->timestamp)) / 1e3);
    return out_stamps;
  }

  TemporaryFolder folder;
  std::filesystem::path in = folder.file("x.rawlog"), out = folder.file("y.rawlog");
};

const std::vector<Object> kSmallRecording{makeOdometry(100, 0, 0, 0), makeScan(100.1), makeImages(100.2),
                                          makeOdometry(101, 1, 0, 0), makeScan(101.1), makeImages(101.2),
                                          makeOdometry(102, 2, 0, 0), makeScan(102.1), makeImages(102.2)};

TEST_F(Damage, WhatNoFaultTouchesKeepsItsBytes) {
  writeRawlog(in, kSmallRecording);
  const auto result = damage({{"drop-lidar", "1:2"}});
  EXPECT_EQ(result.read, 9);
  EXPECT_EQ(result.written, 8);
  EXPECT_NEAR(result.duration_s, 2.2, 1e-6);
  ASSERT_EQ(result.effects.size(), 1u);
  EXPECT_EQ(result.effects[0].fault, "--drop-lidar 1:2");
  EXPECT_EQ(result.effects[0].counts, (std::map<std::string, int>{{"LASER", 1}}));
  const auto left = read();
  ASSERT_EQ(left.size(), 8u);
  for (std::size_t i = 0; i < left.size(); ++i)
    EXPECT_EQ(left[i].bytes, bytesOf(kSmallRecording[i < 4 ? i : i + 1]));
}

TEST_F(Damage, PicturesThatAreMadeAnewLoseNothing) {
  writeRawlog(in, kSmallRecording);
  damage({{"clock-jump", "camera=0:5"}});
  StoredObservationReader before(in);
  const auto after = read();
  for (std::size_t i = 0; const auto stored = before.next(); ++i) {
    const auto a = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(stored->observation);
    if (!a) continue;
    const auto b = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(after[i].observation);
    ASSERT_TRUE(b);
    EXPECT_NEAR(mrpt::Clock::toDouble(b->timestamp), mrpt::Clock::toDouble(a->timestamp) + 5, 1e-6);
    EXPECT_EQ(a->rangeImage, b->rangeImage);
    EXPECT_EQ(cv::norm(a->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY),
                       b->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY), cv::NORM_INF),
              0);
  }
}

TEST_F(Damage, EachFaultGetsWhatTheOneBeforeItLeft) {
  writeRawlog(in, kSmallRecording);
  damage({{"drop-lidar", "0:"}, {"drop-camera", "0:"}, {"duplicate", "1:2"}});
  EXPECT_THAT(stamps(), ElementsAre(100, 101, 101, 102));
  damage({{"duplicate", "lidar=1:2"}, {"drop-camera", "0:"}, {"drop-odometry", "0:"}, {"drop-lidar", "2:"}});
  EXPECT_THAT(stamps(), ElementsAre(100.1, 101.1, 101.1));
}

TEST_F(Damage, WindowsMeanTheTimeThatWasRecordedAndWhatIsHeldBackGoesThroughTheRest) {
  writeRawlog(in, {makeScan(100), makeScan(101), makeScan(102), makeScan(103)});
  // The swap holds the last scan, which has no partner, back until the end; the jumps shift it all the same.
  damage({{"swap-order", "1:"}, {"clock-jump", "1:50"}, {"clock-jump", "lidar=2:0.5"}});
  EXPECT_THAT(stamps(), ElementsAre(100, 152.5, 151, 153.5));
}

TEST_F(Damage, SensoryFramesAndActionsBecomeObservations) {
  auto late = makeAction(-1, 1, 0, 0);
  writeRawlog(in, {makeAction(100, 1, 0, 0), makeSensoryFrame({makeScan(100.1), makeImages(100.2)}), late,
                   makeSensoryFrame({makeScan(101.1)})});
  const auto result = damage({{"drop-camera", "0:1"}});
  EXPECT_EQ(result.read, 5);
  EXPECT_THAT(stamps(), ElementsAre(100, 100.1, 101.1, 101.1));
  const auto all = read();
  const auto second = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(all[2].observation);
  ASSERT_TRUE(second) << "an action without a stamp takes that of the observation after it";
  EXPECT_NEAR(second->odometry.x(), 2, 1e-9);
}

TEST_F(Damage, ImagesInFilesAreInTheCopy) {
  auto images = makeImages(100);
  std::filesystem::create_directory(folder.file("x_Images"));
  cv::imwrite(folder.file("x_Images/a.png").string(), cv::Mat(12, 16, CV_8UC3, cv::Scalar(1, 2, 3)));
  images->intensityImage.setExternalStorage("a.png");
  writeRawlog(in, {makeScan(99), images});
  damage({{"drop-lidar", "0:1"}});
  std::filesystem::remove_all(folder.file("x_Images"));
  const auto all = read();
  ASSERT_EQ(all.size(), 1u);
  const auto copy = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(all[0].observation);
  ASSERT_FALSE(copy->intensityImage.isExternallyStored());
  const cv::Mat pixels = copy->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  EXPECT_EQ(pixels.at<cv::Vec3b>(5, 5), cv::Vec3b(1, 2, 3));
}

TEST_F(Damage, TheSameSeedGivesTheSameBytes) {
  writeRawlog(in, kSmallRecording);
  const auto bytes = [&](std::uint64_t seed) {
    damage({{"noise", "0:"}, {"nan", "lidar=0:"}}, seed);
    return readBytes(out);
  };
  const std::string first = bytes(1);
  EXPECT_EQ(first, bytes(1));
  EXPECT_NE(first, bytes(2));
}

TEST_F(Damage, BrokenAndImpossibleRecordsOfTheInput) {
  const std::string broken = bytesOf(makeScan(100.5)).substr(0, 40) + "\x88";  // its end mark
  auto impossible = makeOdometry(101, std::nan(""), 0, 0);
  writeBytes(in, bytesOf(makeScan(100)) + broken + bytesOf(impossible) + bytesOf(makeScan(102)));
  const auto result = damage({{"drop-lidar", "0:1"}});
  EXPECT_EQ(result.skipped.size(), 1u);
  EXPECT_THAT(result.skipped.begin()->first, HasSubstr("broken record"));
  EXPECT_THAT(stamps(), ElementsAre(101, 102));
}

TEST_F(Damage, ErrorsNameTheFaultAndLeaveNoFile) {
  writeRawlog(in, kSmallRecording);
  const auto says = [&](const std::vector<FaultRequest>& requests, const std::string& text) {
    EXPECT_THAT([&] { damage(requests); }, ThrowsMessage<ConfigError>(HasSubstr(text))) << text;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  says({}, "no fault is asked for");
  says({{"drop-lidr", "1:2"}}, "no fault 'drop-lidr' (did you mean 'drop-lidar'?); known: drop-camera, ");
  says({{"drop-lidar", "50:60"}}, "--drop-lidar 50:60: touches no record; the recording lasts 2.20 s");
  says({{"moving-furniture", "50:60"}}, "touches no record; it needs odometry before it begins, and the recording lasts 2.20 s");
  says({{"drop-lidar", "0:"}, {"drop-camera", "0:"}, {"drop-odometry", "0:"}}, "the faults leave no record");
  says({{"drop-lidar", "2:1"}}, "--drop-lidar 2:1: it ends before it begins; expected A:B");
  EXPECT_THAT(
      [&] {
        damageRawlog(in, in, {{"drop-lidar", "0:1"}}, 1);
      },
      ThrowsMessage<ConfigError>(HasSubstr("x.rawlog")));
  EXPECT_THAT(
      [&] {
        damageRawlog(folder.file("none"), out, {{"drop-lidar", "0:1"}}, 1);
      },
      ThrowsMessage<InputError>(HasSubstr("no such file")));
}

TEST_F(Damage, ProgressMayEndIt) {
  writeRawlog(in, kSmallRecording);
  const auto stop = [](double share) {
    EXPECT_LE(share, 1);
    throw Interrupted("enough");
  };
  EXPECT_THROW(damageRawlog(in, out, {{"drop-lidar", "0:1"}}, 1, stop), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roomgraph
