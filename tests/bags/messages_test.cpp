// SPDX-License-Identifier: BSD-3-Clause
// Bytes of messages by hand and by the writer; conventions of scans, depth and times; records of the bag
// format.
#include "messages.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "byte_writer.h"
#include "decompression.h"
#include "file_window.h"
#include "message_types.h"
#include "message_writing.h"
#include "record_making.h"
#include "roomgraph/datasets/import_images.h"
#include "ros1_records.h"
#include "temporary_folder.h"

namespace roomgraph::bags {
namespace {

RawMessage messageOf(const std::string& bytes, bool cdr = false) {
  RawMessage message;
  message.cdr = cdr;
  message.bytes = Bytes(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return message;
}

std::string hex(std::initializer_list<int> bytes) {
  std::string out;
  for (const int byte : bytes) out += static_cast<char>(byte);
  return out;
}

// seq, seconds, nanoseconds, length and text of the frame.
TEST(Messages, HeaderOfRos1ByHand) {
  const std::string bytes = hex({7, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, '/', 'e', 'y', 'e'});
  const auto header = headerOf(messageOf(bytes));
  EXPECT_EQ(header.stamp_ns, 2'000'000'003);
  EXPECT_EQ(header.frame, "eye") << "old programs put a slash before it";
}

TEST(Messages, HeaderOfCdrByHandInBothOrders) {
  const std::string little = hex({0, 1, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, 'e', 'y', 'e', 0});
  const std::string big = hex({0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 'e', 'y', 'e', 0});
  for (const auto& bytes : {little, big}) {
    const auto header = headerOf(messageOf(bytes, true));
    EXPECT_EQ(header.stamp_ns, 2'000'000'003);
    EXPECT_EQ(header.frame, "eye");
  }
  EXPECT_THROW(headerOf(messageOf(hex({0, 3, 0, 0, 2, 0, 0, 0}), true)), BadMessage) << "a parameter list";
  EXPECT_THROW(headerOf(messageOf(hex({0, 1}), true)), BadMessage);
}

TEST(Messages, CameraInfoTellsWhichLensItIs) {
  mrpt::img::TCamera camera;
  camera.ncols = 64;
  camera.nrows = 48;
  camera.setIntrinsicParamsFromValues(50, 51, 31, 23);
  const auto told = [&] { return decode<CameraInfoMessage>(messageOf(cameraInfoBytes(camera, 0, "eye"))); };
  EXPECT_EQ(told().distortion_model, "plumb_bob");
  EXPECT_EQ(told().distortion, std::vector<double>(5, 0));
  camera.setDistortionKannalaBrandt(0.1, 0.2, 0.3, 0.4);
  EXPECT_EQ(told().distortion_model, "equidistant");
  EXPECT_EQ(told().distortion, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(told().k[4], 51) << "what follows is where it belongs";
  camera.dist = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  EXPECT_EQ(told().distortion_model, "rational_polynomial");
  EXPECT_EQ(told().distortion, std::vector<double>(camera.dist.begin(), camera.dist.end()));
}

TEST(CdrReader, NumbersAreAlignedFromBehindTheHeader) {
  std::string bytes = hex({0, 1, 0, 0}) + std::string(24, '\0');
  bytes[4] = 9;
  bytes[8] = 5;
  bytes.replace(4 + 16, 8, hex({0, 0, 0, 0, 0, 0, 0xf0, 0x3f}));
  CdrReader in(messageOf(bytes).bytes);
  EXPECT_EQ(in.number<std::uint8_t>(), 9);
  EXPECT_EQ(in.number<std::uint32_t>(), 5u);
  EXPECT_EQ(in.take(1).size(), 1u);
  EXPECT_EQ(in.number<double>(), 1) << "from byte 16 of what follows the header, not from 9";
}

TEST(Messages, LengthsBeyondTheMessageAreRefused) {
  ByteWriter scan;
  scan.header(1, "laser").fill(0.1f, 7).put(std::uint32_t{0xffffffffu});
  EXPECT_THROW(decode<LaserScanMessage>(messageOf(scan.bytes())), BadMessage);
  EXPECT_THROW(decode<TransformsMessage>(messageOf(hex({-1, -1, -1, -1}))), BadMessage);
  ByteWriter image;
  image.header(1, "eye").put(2u, 2u).text("mono8").put(std::uint8_t{0}, 2u, std::uint32_t{5}).raw("abcd");
  EXPECT_THROW(imageOf(messageOf(image.bytes()), false), BadMessage);
  EXPECT_EQ(imageHeadOf(messageOf(image.bytes()), false).encoding, "mono8");
}

TEST(Messages, PosesThatAreNoneAreRefused) {
  const auto pose = [](std::initializer_list<double> values) {
    ByteWriter out;
    out.header(1, "world");
    for (const double value : values) out.put(value);
    return out.take();
  };
  EXPECT_NO_THROW(decode<PoseMessage>(messageOf(pose({1, 2, 3, 0, 0, 0, 1.05}))));
  EXPECT_THROW(decode<PoseMessage>(messageOf(pose({1, 2, 3, 0, 0, 0, 0}))), BadMessage);
  EXPECT_THROW(decode<PoseMessage>(messageOf(pose({std::nan(""), 2, 3, 0, 0, 0, 1}))), BadMessage);
  EXPECT_THROW(decode<PoseMessage>(messageOf(pose({1, 2, 3, 0, 0, std::nan(""), 1}))), BadMessage);
}

TEST(Messages, WhatIsWrittenIsReadAgain) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-3, 3);
  for (int i = 0; i < 20; ++i) {
    const Pose3 pose = poseFromYpr(number(random), number(random), number(random), number(random),
                                   number(random) / 3, number(random));
    const std::int64_t t = 1'700'000'000'000'000'000 + i * std::int64_t{123'456'789};
    const auto read = decode<PoseMessage>(messageOf(poseBytes(pose, t, "world")));
    EXPECT_EQ(read.header.stamp_ns, t);
    EXPECT_TRUE(read.pose.isApprox(pose, 1e-12));
    const auto links = decode<TransformsMessage>(
        messageOf(transformsBytes({{"a", "b", pose}, {"b", "c", pose.inverse()}}, t)));
    ASSERT_EQ(links.transforms.size(), 2u);
    EXPECT_EQ(links.transforms[1].header.frame, "b");
    EXPECT_EQ(links.transforms[1].child_frame, "c");
    EXPECT_TRUE(links.transforms[1].parent_from_child.isApprox(pose.inverse(), 1e-12));
  }
}

TEST(Messages, OdometryWithAndWithoutVelocities) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.odometry = {1, -2, 3};
  EXPECT_FALSE(makeOdometry(decode<OdometryMessage>(messageOf(odometryBytes(odometry, 5, "odom", "base"))))
                   ->hasVelocities);
  odometry.hasVelocities = true;
  odometry.velocityLocal = {0.5, 0.1, -0.3};
  const auto message = decode<OdometryMessage>(messageOf(odometryBytes(odometry, 5, "odom", "base")));
  EXPECT_EQ(message.child_frame, "base");
  const auto read = makeOdometry(message);
  EXPECT_TRUE(read->hasVelocities);
  EXPECT_DOUBLE_EQ(read->velocityLocal.omega, -0.3);
  EXPECT_NEAR(read->odometry.phi(), 3, 1e-12);
}

LaserScanMessage scanOf(std::size_t beams, float min, float step) {
  LaserScanMessage scan;
  scan.ranges.assign(beams, 2);
  scan.angle_min = min;
  scan.angle_increment = step;
  scan.angle_max = min + static_cast<float>(beams - 1) * step;
  scan.range_max = 10;
  return scan;
}

TEST(RecordMaking, ScansOfAllDirections) {
  double yaw = 0;
  const auto half = makeScan(scanOf(5, 0, 0.5f), yaw);
  EXPECT_NEAR(yaw, 1, 1e-6) << "the middle of 0 to 2 rad";
  EXPECT_NEAR(half->aperture, 2, 1e-6);
  const auto clockwise = makeScan(scanOf(5, 1, -0.5f), yaw);
  EXPECT_FALSE(clockwise->rightToLeft);
  EXPECT_NEAR(yaw, 0, 1e-6);
  auto odd = scanOf(5, -1, 0.5f);
  odd.angle_max = 1.5f;  // one beam too many
  EXPECT_NEAR(makeScan(odd, yaw)->aperture, 2, 1e-6);
  auto full = scanOf(361, -static_cast<float>(M_PI), static_cast<float>(M_PI / 180));
  EXPECT_NEAR(makeScan(full, yaw)->aperture, 2 * M_PI, 1e-5);
}

TEST(RecordMaking, ScansThatAreNoneAreRefused) {
  double yaw = 0;
  EXPECT_THROW(makeScan(scanOf(0, 0, 0.1f), yaw), BadMessage);
  EXPECT_THROW(makeScan(scanOf(5, 0, 0), yaw), BadMessage);
  EXPECT_THROW(makeScan(scanOf(5, std::nanf(""), 0.1f), yaw), BadMessage);
  EXPECT_THROW(makeScan(scanOf(50, 0, 0.5f), yaw), BadMessage) << "four times around";
  EXPECT_NO_THROW(makeScan(scanOf(1, 0, 0), yaw)) << "a range finder";
}

TEST(RecordMaking, TheMiddleOfASweep) {
  auto scan = scanOf(101, 0, 0.01f);
  scan.time_increment = 0.001f;
  EXPECT_NEAR(static_cast<double>(halfSweepNs(scan)), 50e6, 10);
  scan.time_increment = -0.001f;
  EXPECT_NEAR(static_cast<double>(halfSweepNs(scan)), -50e6, 10);
  scan.time_increment = 5;
  EXPECT_EQ(halfSweepNs(scan), 0) << "no scanner takes minutes";
  scan.time_increment = std::nanf("");
  EXPECT_EQ(halfSweepNs(scan), 0);
}

TEST(RecordMaking, DepthKeepsItsUnitAndLosesWhatIsNone) {
  mrpt::obs::CObservation3DRangeScan record;
  const float nan = std::nanf("");
  const cv::Mat metres =
      (cv::Mat_<float>(1, 6) << 1.0002f, 0, -1, nan, std::numeric_limits<float>::infinity(), 13.2f);
  setDepth(record, metres);
  EXPECT_FLOAT_EQ(record.rangeUnits, 0.0002f);
  EXPECT_EQ(record.rangeImage(0, 0), 5001);
  for (int u = 1; u < 6; ++u) EXPECT_EQ(record.rangeImage(0, u), 0) << u;
  setDepth(record, cv::Mat(1, 1, CV_16UC1, cv::Scalar(65535)));
  EXPECT_FLOAT_EQ(record.rangeUnits, 0.001f);
  EXPECT_EQ(record.rangeImage(0, 0), 65535);
}

TEST(RecordMaking, TimesSurviveBothWays) {
  for (const std::int64_t t :
       {std::int64_t{0}, std::int64_t{1'700'000'000'123'456'700}, std::int64_t{4'000'000'000'000'000'100}})
    EXPECT_EQ(toNanoseconds(toMrptTime(t)), t);
  EXPECT_NEAR(mrpt::Clock::toDouble(toMrptTime(1'700'000'000'500'000'000)), 1700000000.5, 1e-6);
}

TEST(RecordMaking, AnImuThatMeasuresNothing) {
  ImuMessage imu;
  EXPECT_THROW(makeImu(imu), BadMessage);
  imu.has_linear_acceleration = true;
  imu.linear_acceleration = {1, 2, 3};
  const auto record = makeImu(imu);
  EXPECT_DOUBLE_EQ(record->get(mrpt::obs::IMU_Y_ACC), 2);
  EXPECT_FALSE(record->has(mrpt::obs::IMU_WX));
  imu.linear_acceleration[1] = std::nan("");
  EXPECT_THROW(makeImu(imu), BadMessage);
}

TEST(BagRecords, FieldsOfAHeader) {
  const std::string bytes =
      ByteWriter().text("op=" + hex({2})).text("conn=" + hex({1, 2, 0, 0})).text("a=b=c").take();
  const auto fields = parseFields(messageOf(bytes).bytes);
  ASSERT_TRUE(fields);
  EXPECT_EQ(numberIn<std::uint8_t>(*fields, "op"), 2);
  EXPECT_EQ(numberIn<std::uint32_t>(*fields, "conn"), 513u);
  EXPECT_EQ(fields->find("a")->second, "b=c");
  EXPECT_FALSE(numberIn<std::uint64_t>(*fields, "conn")) << "another size";
  EXPECT_FALSE(numberIn<std::uint8_t>(*fields, "none"));
  EXPECT_FALSE(parseFields(messageOf(bytes.substr(0, 7)).bytes));
  EXPECT_FALSE(parseFields(messageOf(ByteWriter().text("no sign").bytes()).bytes));
}

TEST(BagRecords, CompressionThatIsNotKnownOrDamaged) {
  std::vector<std::uint8_t> out;
  const std::string bytes = "neither of them";
  EXPECT_THROW(decompress("zip", messageOf(bytes).bytes, 10, out), BadMessage);
  for (const char* compression : {"bz2", "lz4"}) {
    EXPECT_THROW(decompress(compression, messageOf(bytes).bytes, 1u << 30, out), BadMessage);
    EXPECT_LT(out.capacity(), 4u << 20) << "memory comes with the bytes, not with the size that is claimed";
  }
}

TEST(FileWindow, ReadsAnywhereAndNoFurtherThanTheEnd) {
  const test::TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 100000; ++i) text += static_cast<char>('a' + i % 23);
  FileWindow window(folder.write("x", text));
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const std::size_t at = random() % text.size(), count = random() % 3000;
    const Bytes got = window.at(at, count);
    EXPECT_EQ(std::string(got.begin(), got.end()), text.substr(at, count));
  }
  EXPECT_EQ(window.at(text.size() - 3, 100).size(), 3u);
  EXPECT_TRUE(window.at(text.size(), 1).empty());
}

TEST(MessageTypes, UnknownOnesAreAnError) {
  EXPECT_EQ(messageType("sensor_msgs/Image").name, "sensor_msgs/Image");
  EXPECT_THROW(messageType("sensor_msgs/Smell"), std::out_of_range);
}

}  // namespace
}  // namespace roomgraph::bags
