// SPDX-License-Identifier: BSD-3-Clause
// RecordSorter: order at equal times, look-ahead and delays.
#include "roomgraph/pipeline/record_sorter.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "random_poses.h"

namespace roomgraph::test {
namespace {

Record odometryAt(double t) {
  return OdometryReading{t, {}};
}
Record scanAt(double t) {
  Scan scan;
  scan.t = t;
  return scan;
}
Record frameAt(double t) {
  Frame frame;
  frame.t = t;
  return frame;
}

std::string kindOf(const Record& record) {
  if (std::holds_alternative<Frame>(record)) return "frame";
  return std::holds_alternative<Scan>(record) ? "scan" : "other";
}

TEST(RecordSorter, AtOneTimeWheelsThenScanThenFrame) {
  RecordSorter sorter(0.1);
  sorter.push(frameAt(5));
  sorter.push(odometryAt(5));
  sorter.push(scanAt(5));
  std::vector<std::string> kinds;
  while (const auto record = sorter.pop(true)) kinds.push_back(kindOf(*record));
  EXPECT_EQ(kinds, (std::vector<std::string>{"other", "scan", "frame"}));
}

TEST(RecordSorter, EqualRecordsKeepTheirOrder) {
  RecordSorter sorter(0.1);
  for (int x : {1, 2, 3}) sorter.push(OdometryReading{5, {static_cast<double>(x), 0, 0}});
  for (int x : {1, 2, 3}) EXPECT_EQ(std::get<OdometryReading>(*sorter.pop(true)).odom_from_robot.x, x);
}

TEST(RecordSorter, WaitsUntilNothingEarlierCanCome) {
  RecordSorter sorter(0.5);
  EXPECT_FALSE(sorter.pop(false));
  sorter.push(scanAt(10));
  sorter.push(scanAt(10.4));
  EXPECT_FALSE(sorter.pop(false));
  sorter.push(scanAt(10.6));
  EXPECT_EQ(timeOf(*sorter.pop(false)), 10);
  EXPECT_FALSE(sorter.pop(false));
  EXPECT_EQ(timeOf(*sorter.pop(true)), 10.4);
  EXPECT_EQ(timeOf(*sorter.pop(true)), 10.6);
  EXPECT_FALSE(sorter.pop(true));
}

Record boxesAt(double t) {
  auto boxes = CObservationDetections::Create();
  boxes->timestamp = mrpt::Clock::fromDouble(t);
  return boxes;
}

std::vector<std::string> inOrder(RecordSorter& sorter, const std::vector<Record>& records) {
  std::vector<std::string> out;
  const auto name = [](const Record& record) {
    char text[40];
    std::snprintf(text, sizeof text, "%s %.1f", isBoxes(record) ? "boxes" : kindOf(record).c_str(), timeOf(record));
    return std::string(text);
  };
  for (const Record& record : records) {
    sorter.push(record);
    while (const auto next = sorter.pop(false)) out.push_back(name(*next));
  }
  while (const auto next = sorter.pop(true)) out.push_back(name(*next));
  return out;
}

// Those who publish boxes stamp them when they do.
TEST(RecordSorter, BoxesComeBeforeTheImageTheyWereMadeOf) {
  RecordSorter sorter(0.5);
  EXPECT_EQ(inOrder(sorter, {frameAt(1000), boxesAt(1000.1), frameAt(1001), boxesAt(1001.1), frameAt(1002)}),
            (std::vector<std::string>{"boxes 1000.1", "frame 1000.0", "boxes 1001.1", "frame 1001.0", "frame 1002.0"}));
}

// One stamp is 30 s ahead: what comes after it is sorted all the same.
TEST(RecordSorter, AWrongStampDoesNotHurryTheOthers) {
  RecordSorter sorter(0.5);
  const auto order = inOrder(sorter, {odometryAt(1000), odometryAt(1030), frameAt(1000.2), scanAt(1000.1), frameAt(1000.9), scanAt(1000.8),
                                      frameAt(1001.9), scanAt(1001.8)});
  EXPECT_EQ(order, (std::vector<std::string>{"other 1000.0", "scan 1000.1", "frame 1000.2", "scan 1000.8", "frame 1000.9", "scan 1001.8",
                                             "frame 1001.9", "other 1030.0"}));
}

TEST(RecordSorter, AfterAPauseTimeGoesOn) {
  RecordSorter sorter(0.5);
  sorter.push(odometryAt(1000));
  sorter.push(odometryAt(1060));
  sorter.push(frameAt(1060.1));
  EXPECT_EQ(timeOf(*sorter.pop(false)), 1000) << "two sensors are there";
  EXPECT_FALSE(sorter.pop(false));
  sorter.push(odometryAt(1060.6));
  EXPECT_EQ(timeOf(*sorter.pop(false)), 1060);
}

// A recording of one sensor, or one whose clock is far ahead: memory stays bounded.
TEST(RecordSorter, ManyAheadAreNotWaitedFor) {
  RecordSorter sorter(0.5);
  sorter.push(scanAt(1000));
  int waiting = 0;
  for (int i = 0; i < 200; ++i) {
    sorter.push(scanAt(1030 + 0.1 * i));
    ++waiting;
    while (sorter.pop(false)) --waiting;
    EXPECT_LT(waiting, 40);
  }
  EXPECT_LT(waiting, 8);
}

TEST(RecordSorter, DelaysWithinTheLookaheadAreUndone) {
  Random random(4);
  std::vector<std::pair<double, double>> arrivals;  // when it arrives, its stamp
  for (int i = 0; i < 300; ++i) arrivals.emplace_back(0.05 * i + random.uniform(0, 0.29), 0.05 * i);
  std::sort(arrivals.begin(), arrivals.end());
  RecordSorter sorter(0.3);
  std::vector<double> stamps;
  for (const auto& [arrival, stamp] : arrivals) {
    sorter.push(scanAt(stamp));
    while (const auto record = sorter.pop(false)) stamps.push_back(timeOf(*record));
  }
  while (const auto record = sorter.pop(true)) stamps.push_back(timeOf(*record));
  EXPECT_EQ(stamps.size(), 300u);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
}

}  // namespace
}  // namespace roomgraph::test
