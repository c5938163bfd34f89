// SPDX-License-Identifier: BSD-3-Clause
// Faults of whole records and of clocks: which records come out, in which order, with which stamps.
#include "record_faults.h"

#include <gmock/gmock.h>

#include "clock_jump.h"
#include "passing_records.h"

namespace roomgraph {
namespace {

using namespace test;
using enum FaultySensor;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Truly;

const StruckSensors kAnySensor{kCamera, kLidar, kOdometry, kOther};
constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(DropFault, TakesTheSensorsRecordsInTheWindowAndNoOther) {
  DropFault fault({kLidar}, {1, 3});
  const auto left = through(
      fault, {scanAt(0.5), odometryAt(1, 0), scanAt(1), imagesAt(2), scanAt(2.9), scanAt(3), scanAt(4)});
  EXPECT_THAT(stampsOf(left), ElementsAre(0.5, 1, 2, 3, 4));
  EXPECT_EQ(left[1].sensor, kOdometry);
  EXPECT_EQ(left[2].sensor, kCamera);
  EXPECT_THAT(left, Each(Truly(keepsBytes)));
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 2}}));
}

TEST(DropFault, CameraTakesItsDetectionsAlongAndOpenWindowsEndWithTheRecording) {
  DropFault fault({kCamera}, {1, kNever});
  const auto left =
      through(fault, {boxesAt(0), imagesAt(0), boxesAt(1), imagesAt(1), scanAt(1), imagesAt(900)});
  EXPECT_THAT(stampsOf(left), ElementsAre(0, 0, 1));
  EXPECT_EQ(fault.counts(), (Counts{{"BOXES", 1}, {"KINECT", 2}}));
}

TEST(DropFault, ARecordWithoutStampIsInNoWindow) {
  PassingRecord scan = scanAt(0);
  scan.t = std::numeric_limits<double>::quiet_NaN();
  DropFault fault({kLidar}, {0, kNever});
  EXPECT_EQ(through(fault, {scan}).size(), 1u);
  EXPECT_THAT(fault.counts(), IsEmpty());
}

TEST(FreezeFault, RepeatsTheLastRecordBeforeTheWindowWithNewStamps) {
  FreezeFault fault(kLidar, {1, 2.5});
  const auto out = through(
      fault, {scanAt(0, 2), scanAt(0.5, 3), odometryAt(1, 7), scanAt(1, 4), scanAt(2, 5), scanAt(3, 6)});
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 0.5, 1, 1, 2, 3));
  std::vector<float> ranges;
  for (const auto& record : out)
    if (record.sensor == kLidar) ranges.push_back(scanOf(record).getScanRange(0));
  EXPECT_THAT(ranges, ElementsAre(2, 3, 3, 3, 6));
  EXPECT_EQ(odometryOf(out[2]).x(), 7);
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 2}}));
  EXPECT_TRUE(keepsBytes(out[1]));
  EXPECT_TRUE(out[3].bytes.empty());
}

// A chain of faults: what a later one does to a record in place must not be in what is repeated.
TEST(FreezeFault, RepeatsTheRecordAsItWas) {
  FreezeFault fault(kLidar, {1, 2.5});
  PassingRecords first = fault.pass(scanAt(0.5, 3));
  std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(first.at(0).observation)->setScanRange(0, 9);
  const PassingRecords again = fault.pass(scanAt(1, 4));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(scanOf(again[0]).getScanRange(0), 3);
}

TEST(FreezeFault, EachLabelHasItsOwnAndTheFirstInTheWindowStandsWhereNoneCameBefore) {
  PassingRecord other = scanAt(0.1, 5);
  other.observation->sensorLabel = "REAR";
  PassingRecord later = scanAt(0.3, 6);
  later.observation->sensorLabel = "REAR";
  FreezeFault fault(kLidar, {0, 1});
  const auto out = through(fault, {scanAt(0, 2), other, scanAt(0.2, 3), later});
  EXPECT_FLOAT_EQ(scanOf(out[2]).getScanRange(0), 2);
  EXPECT_FLOAT_EQ(scanOf(out[3]).getScanRange(0), 5);
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 1}, {"REAR", 1}}));
}

TEST(FreezeFault, PicturesAndTheirDetectionsFreezeTogether) {
  PassingRecord boxes = boxesAt(1);
  FreezeFault fault(kCamera, {1, 2});
  PassingRecord changed = imagesAt(1);
  dynamic_cast<mrpt::obs::CObservation3DRangeScan&>(*changed.observation).rangeImage(3, 3) = 9;
  const auto out = through(fault, {boxesAt(0), imagesAt(0), boxes, changed});
  EXPECT_EQ(imagesOf(out[3]).rangeImage(3, 3), imagesOf(out[1]).rangeImage(3, 3));
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 0, 1, 1));
  EXPECT_EQ(fault.counts(), (Counts{{"BOXES", 1}, {"KINECT", 1}}));
}

TEST(PassingRecord, IsCountedByItsLabelElseByItsClass) {
  PassingRecord boxes = boxesAt(0), scan = scanAt(0);
  boxes.observation->sensorLabel.clear();  // MRPT does not save the label of a comment
  EXPECT_EQ(boxes.label(), "BOXES");
  EXPECT_EQ(boxes.sensor, kCamera);
  scan.observation->sensorLabel.clear();
  EXPECT_EQ(scan.label(), "CObservation2DRangeScan");
}

TEST(DuplicateFault, EachRecordOfTheWindowComesTwice) {
  DuplicateFault fault(kAnySensor, {1, 2});
  const auto out = through(fault, {scanAt(0), scanAt(1), odometryAt(1.5, 3), scanAt(2)});
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 1, 1, 1.5, 1.5, 2));
  EXPECT_EQ(out[1].bytes, out[2].bytes);
  EXPECT_NE(out[1].observation, out[2].observation);
  EXPECT_THAT(out, Each(Truly(keepsBytes)));
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 1}, {"ODOMETRY", 1}}));
}

TEST(SwapFault, NeighboursOfTheWindowChangePlaces) {
  SwapFault fault(kAnySensor, {1, 5});
  const auto out =
      through(fault, {scanAt(0), scanAt(1), odometryAt(2, 0), scanAt(3), scanAt(4), scanAt(4.5), scanAt(5)});
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 2, 1, 4, 3, 4.5, 5));
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 3}, {"ODOMETRY", 1}}));
  EXPECT_THAT(out, Each(Truly(keepsBytes)));
}

TEST(SwapFault, OfOneSensorStepsOverTheOthers) {
  SwapFault fault({kLidar}, {0, kNever});
  const auto out = through(fault, {scanAt(0), odometryAt(0.5, 0), scanAt(1), odometryAt(1.5, 0), scanAt(2)});
  EXPECT_THAT(stampsOf(out), ElementsAre(0.5, 1, 0, 1.5, 2));
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 2}}));
}

TEST(ClockJumpFault, ShiftsStampsFromThenOnAndNothingElse) {
  ClockJumpFault fault({kLidar}, 1, 2.5);
  const auto out = through(fault, {scanAt(0, 3), scanAt(1, 4), odometryAt(1.5, 0), scanAt(2, 5)});
  EXPECT_THAT(stampsOf(out), ElementsAre(0, 3.5, 1.5, 4.5));
  EXPECT_FLOAT_EQ(scanOf(out[3]).getScanRange(0), 5);
  EXPECT_EQ(out[1].t, 1) << "windows of other faults mean the time that was recorded";
  EXPECT_TRUE(keepsBytes(out[0]));
  EXPECT_TRUE(out[1].bytes.empty());
  EXPECT_EQ(fault.counts(), (Counts{{"LASER", 2}}));
}

TEST(ClockJumpFault, GoesBackwardsToo) {
  ClockJumpFault fault(kAnySensor, 1, -0.75);
  EXPECT_THAT(stampsOf(through(fault, {scanAt(0), odometryAt(1, 0), boxesAt(2)})),
              ElementsAre(0, 0.25, 1.25));
}

}  // namespace
}  // namespace roomgraph
