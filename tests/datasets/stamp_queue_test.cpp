// SPDX-License-Identifier: BSD-3-Clause
// StampQueue: isolated wrong stamps against gaps, pauses and separate clocks.
#include "stamp_queue.h"

#include <gmock/gmock.h>

#include <vector>

namespace roomgraph {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct Stamp {
  const char* sensor;
  double t;
};

/// Numbers of the records whose stamps are found wrong; all records must come out, in order.
std::vector<int> wrongOf(const std::vector<Stamp>& stamps) {
  StampQueue<int> queue;
  std::vector<int> wrong, order;
  const auto take = [&](bool complete) {
    while (const auto item = queue.pop(complete)) {
      order.push_back(item->record);
      if (item->stamp_is_wrong) wrong.push_back(item->record);
    }
  };
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    queue.push(stamps[i].sensor, stamps[i].t, static_cast<int>(i));
    take(false);
  }
  take(true);
  EXPECT_THAT(order, SizeIs(stamps.size()));
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  return wrong;
}

TEST(StampQueue, OrdinaryRecordsPassAtOnce) {
  StampQueue<int> queue;
  queue.push("a", 1000, 0);
  EXPECT_FALSE(queue.pop(false)) << "the first stamp needs a second";
  queue.push("a", 1000.1, 1);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(queue.pop(false));
  for (int i = 2; i < 50; ++i) {
    queue.push("a", 1000 + 0.1 * i, i);
    EXPECT_TRUE(queue.pop(false)) << i;
  }
}

TEST(StampQueue, OneFarFromItsNeighboursIsWrong) {
  EXPECT_THAT(wrongOf({{"a", 0}, {"a", 1}, {"a", 5000}, {"a", 2}, {"a", 3}}), ElementsAre(2));
  EXPECT_THAT(wrongOf({{"a", 9000}, {"a", 9001}, {"a", 5}, {"a", 9002}}), ElementsAre(2));
  EXPECT_THAT(wrongOf({{"a", 0}, {"b", 0.5}, {"b", 1e9}, {"a", 1}, {"b", 1.5}}), ElementsAre(2));
}

TEST(StampQueue, TheFirstAndTheLastAreJudgedByWhatIsThere) {
  EXPECT_THAT(wrongOf({{"a", 1e9}, {"a", 0}, {"a", 1}, {"a", 2}}), ElementsAre(0));
  EXPECT_THAT(wrongOf({{"a", 0}, {"a", 1e9}, {"a", 1}, {"a", 2}}), ElementsAre(1));
  EXPECT_THAT(wrongOf({{"a", 0}, {"a", 1}, {"a", 1e9}}), ElementsAre(2));
  EXPECT_THAT(wrongOf({{"a", 7}}), IsEmpty());
  EXPECT_THAT(wrongOf({{"a", 7}, {"a", 500}}), ElementsAre(1)) << "either may be wrong";
}

TEST(StampQueue, AGapInTheRecordingIsNoDamage) {
  EXPECT_THAT(
      wrongOf({{"a", 0}, {"b", 0.1}, {"a", 1}, {"a", 7200}, {"b", 7200.1}, {"a", 7201}, {"b", 7201.1}}),
      IsEmpty());
  EXPECT_THAT(wrongOf({{"a", 0}, {"a", 100}, {"a", 200}, {"a", 300}}), ElementsAre(3))
      << "slow, but regular: only of the last nothing can be said";
}

// After a pause a fast sensor is back long before the second record of a slow one.
TEST(StampQueue, ASlowSensorComesBackAfterAPause) {
  for (const double apart : {0.0, 500.0}) {
    std::vector<Stamp> stamps;
    for (int i = 0; i < 90 * 150; ++i) {
      const double t = i / 90.0;
      if (t > 20 && t < 85) continue;
      stamps.push_back({"lidar", 1000 + t});
      if (i % 90 == 0) stamps.push_back({"camera", 1000 + t + apart});
    }
    EXPECT_THAT(wrongOf(stamps), IsEmpty()) << "clocks apart by " << apart;
  }
}

TEST(StampQueue, ClocksApartAreNoDamage) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < 20; ++i) {
    stamps.push_back({"a", 1000 + 0.1 * i});
    stamps.push_back({"b", 0.1 * i});
  }
  EXPECT_THAT(wrongOf(stamps), IsEmpty());
}

TEST(StampQueue, WaitsForALimitedNumberOfRecords) {
  StampQueue<int> queue;
  queue.push("rare", 0, 0);
  int pushed = 1;
  while (!queue.pop(false) && pushed < 1000) queue.push("often", 0.1 * pushed, pushed), ++pushed;
  EXPECT_LT(pushed, 100);
}

}  // namespace
}  // namespace roomgraph
