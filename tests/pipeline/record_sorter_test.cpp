// SPDX-License-Identifier: BSD-3-Clause
// RecordSorter: order at equal times, look-ahead and delays.
#include "roomgraph/pipeline/record_sorter.h"

#include <gtest/gtest.h>

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
