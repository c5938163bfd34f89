// SPDX-License-Identifier: BSD-3-Clause
// Replay of records that come from no file: a stream of one's own, out of order, with a sink.
#include <gtest/gtest.h>

#include <algorithm>

#include "drive.h"
#include "roomgraph/pipeline/replay.h"

namespace roomgraph::test {
namespace {

// Wheels and a lidar; the wheels' records come a quarter of a second late.
class SimulatedDriver : public RecordStream {
 public:
  std::optional<Record> next() override {
    const int i = given_++;
    if (i >= 2 * kScans) return std::nullopt;
    if (i % 2 == 0) return drive_.scan(0.1 * (i / 2));
    const double t = 0.1 * (i / 2) - 0.25;
    if (t < 0) return next();
    return drive_.odometry(t);
  }
  double progress() const override { return given_ / (2.0 * kScans); }

  static constexpr int kScans = 60;

 private:
  Drive drive_;
  int given_ = 0;
};

struct TimesSeen : Sink {
  std::vector<double> times;
  void onStep(const StepReport& step) override {
    if (step.t > 0) times.push_back(step.t);
  }
};

TEST(ReplayStream, RecordsOfADriverBecomeATrajectory) {
  SemanticSlam slam(setupWith("[tracking]\nenabled = false\n[detection]\nenabled = false\n"));
  const auto seen = std::make_shared<TimesSeen>();
  slam.addSink(seen);
  SimulatedDriver driver;
  std::vector<double> shares;
  const ReplayState state =
      replay(driver, slam, {}, {.progress = [&](const ReplayState& now) { shares.push_back(now.share); }});
  EXPECT_EQ(state.records, static_cast<int>(shares.size()));
  EXPECT_GT(state.records, 110);
  EXPECT_TRUE(std::is_sorted(seen->times.begin(), seen->times.end())) << "put in order of time";
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  const SlamResult result = slam.finish();
  ASSERT_FALSE(result.world_from_robot.empty());
  const StampedPose& last = result.world_from_robot.back();
  const Pose3 truth = toPose3(Drive::truth(last.t));
  EXPECT_LT((last.pose.translation() - truth.translation()).norm(), 0.03);
}

// Boxes are fed before what was recorded at their time: a recording begins and ends with its other records.
class DriverWithBoxes : public RecordStream {
 public:
  std::optional<Record> next() override {
    const int i = given_++;
    if (i >= 2 * kScans) return std::nullopt;
    const double t = 1000 + 0.1 * (i / 2);
    if (i % 2 == 1) {
      auto boxes = CObservationDetections::Create();
      boxes->timestamp = mrpt::Clock::fromDouble(t + 0.1);
      return boxes;
    }
    Scan scan = drive_.scan(t - 1000);
    scan.t = t;
    return scan;
  }
  double progress() const override { return given_ / (2.0 * kScans); }

 private:
  static constexpr int kScans = 60;
  Drive drive_;
  int given_ = 0;
};

TEST(ReplayStream, BoxesNeitherBeginNorEndIt) {
  for (const auto& [from_s, until_s, boxes] : {std::tuple(0., 0., 60), std::tuple(0., 2.05, 20), std::tuple(1.05, 2.05, 10)}) {
    SemanticSlam slam(setupWith("[tracking]\nenabled = false\n[odometry]\nenabled = false\n[detection]\nenabled = false\n"));
    DriverWithBoxes driver;
    const ReplayState state = replay(driver, slam, {.from_s = from_s, .until_s = until_s}, {});
    EXPECT_NEAR(state.start_t, 1000, 1e-6);
    EXPECT_NEAR(state.first_t, from_s > 0 ? 1001.1 : 1000, 1e-6);
    EXPECT_NEAR(state.last_t, until_s > 0 ? 1002 : 1005.9, 1e-6);
    EXPECT_EQ(slam.finish().counts.detections, boxes) << from_s << " to " << until_s;
  }
}

TEST(ReplayStream, StopsWhereItIsInterrupted) {
  SemanticSlam slam(setupWith("[tracking]\nenabled = false\n[detection]\nenabled = false\n"));
  SimulatedDriver driver;
  int asked = 0;
  const ReplayState state = replay(driver, slam, {}, {.interrupted = [&] { return ++asked > 21; }});
  EXPECT_TRUE(state.interrupted);
  EXPECT_EQ(state.records, 21);
  EXPECT_FALSE(slam.finish().world_from_robot.empty()) << "what was computed is not lost";
}

}  // namespace
}  // namespace roomgraph::test
