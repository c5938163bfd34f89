// SPDX-License-Identifier: BSD-3-Clause
// RawlogReader: both formats and storages, odometry from actions, skipped and unusable records.
#include "roomgraph/datasets/rawlog_reader.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "rawlog_maker.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using namespace roomgraph::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

std::vector<Record> readAll(RawlogReader& reader) {
  std::vector<Record> records;
  while (auto record = reader.next()) records.push_back(std::move(*record));
  return records;
}

class BothStorages : public testing::TestWithParam<bool> {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("x.rawlog");
};
INSTANTIATE_TEST_SUITE_P(Storage, BothStorages, testing::Bool(),
                         [](const auto& storage) { return storage.param ? "Gzip" : "Plain"; });

TEST_P(BothStorages, ObservationOnlyComesOutInFileOrder) {
  auto detections = std::make_shared<CObservationDetections>();
  detections->timestamp = mrpt::Clock::fromDouble(10.2);
  detections->items.push_back({"chair", 0.5f, 1, 2, 3, 4, 7});
  writeRawlog(file_, {makeImages(10.0), makeScan(10.3), makeOdometry(10.1, 1, 2, 0.5), detections},
              GetParam());

  RawlogReader reader(file_);
  const auto records = readAll(reader);
  ASSERT_EQ(records.size(), 4u);
  const auto& frame = std::get<Frame>(records[0]);
  EXPECT_NEAR(frame.t, 10.0, 1e-6);
  EXPECT_EQ(frame.id.value, 0);
  EXPECT_EQ(frame.sensor_label, "KINECT");
  const auto& scan = std::get<Scan>(records[1]);
  EXPECT_NEAR(scan.ranges_m[4], 2.4f, 1e-6);
  const auto& odometry = std::get<OdometryReading>(records[2]);
  EXPECT_NEAR(odometry.odom_from_robot.y, 2, 1e-9);
  const auto& boxes = *std::get<std::shared_ptr<CObservationDetections>>(records[3]);
  EXPECT_EQ(boxes.items.at(0).track, 7);
  EXPECT_NEAR(timeOf(records[3]), 10.2, 1e-6);
  EXPECT_THAT(reader.statistics().warning, IsEmpty());
  EXPECT_THAT(reader.statistics().skipped, IsEmpty());
  EXPECT_EQ(reader.statistics().used.at("CObservation2DRangeScan"), 1);
  EXPECT_DOUBLE_EQ(reader.progress(), 1);
}

TEST_P(BothStorages, ActionsAreSummedUpAndSensoryFramesTakenApart) {
  // 1 m ahead, then 90 degrees to the left, then 2 m ahead: at (1, 2), facing +y.
  writeRawlog(file_,
              {makeAction(1, 1, 0, 0), makeSensoryFrame({makeScan(1.1), makeScan(1.2)}),
               makeAction(-1, 0, 0, M_PI / 2), makeSensoryFrame({makeScan(2.5)}), makeAction(3, 2, 0, 0),
               makeSensoryFrame({})},
              GetParam());
  RawlogReader reader(file_);
  const auto records = readAll(reader);
  ASSERT_EQ(records.size(), 6u);
  EXPECT_NEAR(std::get<OdometryReading>(records[0]).t, 1, 1e-6);
  EXPECT_NEAR(std::get<OdometryReading>(records[0]).odom_from_robot.x, 1, 1e-9);
  EXPECT_NEAR(timeOf(records[2]), 1.2, 1e-6);
  // The second action has no time: it takes that of the sensory frame after it, and comes before it.
  EXPECT_NEAR(std::get<OdometryReading>(records[3]).t, 2.5, 1e-6);
  EXPECT_TRUE(std::holds_alternative<Scan>(records[4]));
  const auto& last = std::get<OdometryReading>(records[5]).odom_from_robot;
  EXPECT_NEAR(last.x, 1, 1e-9);
  EXPECT_NEAR(last.y, 2, 1e-9);
  EXPECT_NEAR(last.yaw, M_PI / 2, 1e-9);
  EXPECT_EQ(reader.statistics().used.at("CActionCollection"), 3);
}

TEST(RawlogReader, PoseChangeAndSpatialMovementCountAsOdometry) {
  TemporaryFolder folder;
  mrpt::obs::CActionRobotMovement2D matched;
  matched.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  matched.poseChange = mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(0.5, 0, 0));
  matched.timestamp = mrpt::Clock::fromDouble(1);
  mrpt::obs::CActionRobotMovement3D spatial;
  spatial.poseChange.mean = mrpt::poses::CPose3D(0.25, 0, 0.1, 0, 0, 0);
  spatial.timestamp = mrpt::Clock::fromDouble(2);
  auto first = mrpt::obs::CActionCollection::Create(), second = mrpt::obs::CActionCollection::Create();
  first->insert(matched);
  second->insert(spatial);
  const auto empty = mrpt::obs::CActionCollection::Create();
  writeRawlog(folder.file("x.rawlog"), {first, makeSensoryFrame({}), second, makeSensoryFrame({}), empty});
  RawlogReader reader(folder.file("x.rawlog"));
  const auto records = readAll(reader);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_NEAR(std::get<OdometryReading>(records[1]).odom_from_robot.x, 0.75, 1e-9);
  EXPECT_THAT(reader.statistics().skipped,
              ElementsAre(Pair("CActionCollection: no movement of the robot in it", 1)));
}

TEST(RawlogReader, WheelsArePreferredToAScanMatcherWhateverComesFirst) {
  using Movement = mrpt::obs::CActionRobotMovement2D;
  for (const bool wheels_first : {true, false}) {
    Movement wheels, matched;
    wheels.computeFromOdometry({1, 0, 0}, {});
    matched.estimationMethod = Movement::emScan2DMatching;
    matched.poseChange = mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(5, 0, 0));
    wheels.timestamp = matched.timestamp = mrpt::Clock::fromDouble(1);
    auto actions = mrpt::obs::CActionCollection::Create();
    actions->insert(wheels_first ? wheels : matched);
    actions->insert(wheels_first ? matched : wheels);
    TemporaryFolder folder;
    writeRawlog(folder.file("x.rawlog"), {actions, makeSensoryFrame({makeScan(1)})});
    RawlogReader reader(folder.file("x.rawlog"));
    const auto records = readAll(reader);
    ASSERT_FALSE(records.empty());
    EXPECT_NEAR(std::get<OdometryReading>(records[0]).odom_from_robot.x, 1, 1e-9) << wheels_first;
  }
}

TEST(RawlogReader, LastActionWithoutTimeIsCounted) {
  TemporaryFolder folder;
  writeRawlog(folder.file("x.rawlog"), {makeSensoryFrame({makeScan(1)}), makeAction(-1, 1, 0, 0)});
  RawlogReader reader(folder.file("x.rawlog"));
  EXPECT_EQ(readAll(reader).size(), 1u);
  EXPECT_THAT(reader.statistics().skipped, ElementsAre(Pair(HasSubstr("no observation after it"), 1)));
}

TEST(RawlogReader, WhatIsNotWantedIsSteppedOver) {
  TemporaryFolder folder;
  writeRawlog(folder.file("x.rawlog"),
              {makeImages(1), makeScan(2), makeImages(3), makeOdometry(4, 0, 0, 0), makeImages(5)});
  RawlogReader scans(folder.file("x.rawlog"), {.frames = false, .scans = true, .odometry = false});
  const auto records = readAll(scans);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_NEAR(timeOf(records[0]), 2, 1e-6);
  EXPECT_THAT(scans.statistics().skipped, ElementsAre(Pair("CObservation3DRangeScan: not asked for", 3),
                                                      Pair("CObservationOdometry: not asked for", 1)));
  EXPECT_THAT(scans.statistics().warning, IsEmpty());
  RawlogReader frames(folder.file("x.rawlog"), {.frames = true, .scans = false, .odometry = false});
  EXPECT_EQ(readAll(frames).size(), 3u);
}

TEST(RawlogReader, OtherClassesAndInvalidTimesAreCounted) {
  TemporaryFolder folder;
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->timestamp = mrpt::Clock::fromDouble(1);
  auto timeless = makeScan(1);
  timeless->timestamp = INVALID_TIMESTAMP;
  writeRawlog(folder.file("x.rawlog"), {comment, timeless, makeScan(3)});
  RawlogReader reader(folder.file("x.rawlog"));
  EXPECT_EQ(readAll(reader).size(), 1u);
  EXPECT_THAT(reader.statistics().skipped, ElementsAre(Pair("CObservation2DRangeScan: invalid time stamp", 1),
                                                       Pair("CObservationComment: not used", 1)));
}

std::string openError(const std::filesystem::path& file) {
  try {
    RawlogReader reader(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(RawlogReader, UnusableFilesAreRefusedInOneLine) {
  TemporaryFolder folder;
  EXPECT_THAT(openError(folder.file("none.rawlog")), HasSubstr("none.rawlog: no such file"));
  EXPECT_THAT(openError(folder.path()), HasSubstr("directory"));
  writeBytes(folder.file("empty.rawlog"), "");
  EXPECT_THAT(openError(folder.file("empty.rawlog")), HasSubstr("empty"));
  writeBytes(folder.file("text.rawlog"), "timestamp,x,y\n1,2,3\n");
  EXPECT_THAT(openError(folder.file("text.rawlog")), HasSubstr("not a rawlog"));
  writeBytes(folder.file("gz.rawlog"),
             std::string("\x1f\x8b\x08\x00", 4) + "garbage that is no deflate stream");
  EXPECT_THAT(openError(folder.file("gz.rawlog")), HasSubstr("not a rawlog"));
  writeRawlog(folder.file("pose.rawlog"), {std::make_shared<mrpt::poses::CPose3D>()});
  EXPECT_THAT(openError(folder.file("pose.rawlog")), HasSubstr("CPose3D"));
  EXPECT_THAT(openError(folder.file("pose.rawlog")), testing::Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace roomgraph
