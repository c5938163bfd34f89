// SPDX-License-Identifier: BSD-3-Clause
// Order of records, pairs of colour and depth, and clocks of topics.
#include "record_queue.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "survey.h"

namespace roomgraph::bags {
namespace {

constexpr std::int64_t kMs = 1'000'000;

WaitingRecord record(std::int64_t t_ms, std::int64_t received_ms, bool is_color = false) {
  WaitingRecord out;
  out.observation = mrpt::obs::CObservationOdometry::Create();
  out.t_ns = t_ms * kMs;
  out.received_ns = received_ms * kMs;
  out.is_color = is_color;
  return out;
}

cv::Mat depth(int value) {
  return cv::Mat(1, 1, CV_16UC1, cv::Scalar(value));
}

int valueOf(const cv::Mat& image) {
  return image.empty() ? 0 : image.at<std::uint16_t>(0, 0);
}

std::vector<std::int64_t> popAll(RecordQueue& queue, bool all) {
  std::vector<std::int64_t> times;
  while (const auto next = queue.pop(all)) times.push_back(next->t_ns / kMs);
  return times;
}

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(RecordQueue, LateRecordsFindTheirPlaces) {
  RecordQueue queue(1, 0.02);
  queue.push(record(100, 100));
  queue.push(record(300, 300));
  queue.push(record(200, 900));  // of a slow sensor
  EXPECT_THAT(popAll(queue, false), IsEmpty()) << "earlier ones may come within a second";
  queue.push(record(1500, 1500));
  EXPECT_THAT(popAll(queue, false), ElementsAre(100)) << "what waits for 200 may not overtake it";
  queue.push(record(2000, 2000));
  EXPECT_THAT(popAll(queue, false), ElementsAre(200, 300));
  EXPECT_THAT(popAll(queue, true), ElementsAre(1500, 2000));
}

TEST(RecordQueue, MemoryIsBoundedByBytes) {
  RecordQueue queue(1000, 0.02);
  for (int i = 0; i < 10; ++i) {
    auto large = record(i, i);
    large.bytes = 100u << 20;
    queue.push(std::move(large));
  }
  EXPECT_THAT(popAll(queue, false), ElementsAre(0, 1, 2, 3, 4)) << "512 MB hold five of 100 MB";
}

TEST(RecordQueue, DepthIsTheNearestWithinTheLimit) {
  RecordQueue queue(1, 0.02);
  queue.pushDepth(90 * kMs, 90 * kMs, depth(1));
  queue.pushDepth(105 * kMs, 105 * kMs, depth(2));
  queue.pushDepth(130 * kMs, 130 * kMs, depth(3));
  EXPECT_EQ(valueOf(queue.takeDepth(100 * kMs)), 2);
  EXPECT_EQ(valueOf(queue.takeDepth(100 * kMs)), 1) << "what is left";
  EXPECT_EQ(valueOf(queue.takeDepth(100 * kMs)), 0) << "30 ms away";
  EXPECT_EQ(valueOf(queue.takeDepth(110 * kMs)), 3);
}

TEST(RecordQueue, DepthIsLeftToTheColourImageThatIsNearer) {
  RecordQueue queue(1, 0.02);
  queue.push(record(115, 115, true));
  queue.pushDepth(112 * kMs, 112 * kMs, depth(1));
  EXPECT_EQ(valueOf(queue.takeDepth(100 * kMs)), 0);
  EXPECT_EQ(valueOf(queue.takeDepth(115 * kMs)), 1);
  queue.push(record(215, 215, false));  // no image
  queue.pushDepth(212 * kMs, 212 * kMs, depth(2));
  EXPECT_EQ(valueOf(queue.takeDepth(200 * kMs)), 2);
}

TEST(RecordQueue, APauseOfTheRecorderCostsNoPairs) {
  RecordQueue queue(1, 0.02);
  queue.push(record(100, 100, true));
  queue.pushDepth(105 * kMs, 105 * kMs, depth(1));
  queue.push(record(9000, 9000));
  EXPECT_EQ(queue.pop(false)->t_ns, 100 * kMs);
  EXPECT_EQ(valueOf(queue.takeDepth(100 * kMs)), 1);
  EXPECT_FALSE(queue.pop(false));
  EXPECT_EQ(queue.unpairedDepth(), 0);
}

TEST(RecordQueue, DepthWithoutColourIsForgottenAndCounted) {
  RecordQueue queue(1, 0.02);
  for (int i = 0; i < 4; ++i) queue.pushDepth(i * kMs, i * kMs, depth(i + 1));
  queue.push(record(5000, 5000));
  popAll(queue, false);
  EXPECT_EQ(queue.unpairedDepth(), 4);
  queue.pushDepth(5000 * kMs, 5000 * kMs, depth(9));
  queue.clear();
  EXPECT_EQ(queue.unpairedDepth(), 5);
}

TEST(ClockDelays, MedianAndDriftOfMoreThanAreKept) {
  ClockDelays none;
  EXPECT_FALSE(none.summary());
  ClockDelays drifting;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) drifting.add(1.0 * i / kCount);
  const auto summary = drifting.summary();
  ASSERT_TRUE(summary);
  EXPECT_NEAR(summary->median, 0.5, 0.01);
  EXPECT_NEAR(summary->first, 0.125, 0.01);
  EXPECT_NEAR(summary->last, 0.875, 0.01);
}

TEST(ClockDelays, SinglePausesOfTheRecorderDoNotCount) {
  ClockDelays delays;
  for (int i = 0; i < 1000; ++i) delays.add(i % 10 == 0 ? -5 : 0.01);
  EXPECT_NEAR(delays.summary()->median, 0.01, 1e-9);
}

}  // namespace
}  // namespace roomgraph::bags
