// SPDX-License-Identifier: BSD-3-Clause
// Scans matched before their turn: the same bits, until an image comes, and to where a run was interrupted.
#include "scans_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "drive.h"

namespace roomgraph::test {
namespace {

constexpr std::size_t kAhead = 9;

class ScansAheadTest : public ::testing::Test {
 protected:
  ScansAheadTest() { registerAllClasses(); }

  static std::unique_ptr<SemanticSlam> newRun() {
    return std::make_unique<SemanticSlam>(setupWith("[tracking]\nenabled = false\n[detection]\nenabled = false\n"));
  }
  static std::size_t matched(const SemanticSlam& slam) { return slam.setup().stages.scan_matcher->trajectory().size(); }

  /// A third of a lap, with records that are left out; images from `images_from` seconds on.
  static std::vector<Record> lap(double images_from = 1e300) {
    Drive drive;
    std::vector<Record> out;
    for (int i = 0; i < 40; ++i) {
      const double t = 0.1 * i;
      out.emplace_back(drive.odometry(t));
      if (i % 8 == 5) out.emplace_back(drive.odometry(t - 0.05));
      if (t >= images_from) out.emplace_back(Drive::frame(t));
      out.emplace_back(drive.scan(t + 0.02));
      if (i % 10 == 3) out.emplace_back(drive.scan(t - 0.1));
      if (i % 10 == 7) {
        Scan broken = drive.scan(t + 0.04);
        broken.valid.pop_back();
        out.emplace_back(std::move(broken));
      }
    }
    return out;
  }

  static std::vector<double> outcome(SemanticSlam& slam) {
    std::vector<double> out;
    for (const auto& stamped : slam.finish().world_from_robot) {
      out.push_back(stamped.t);
      for (const double value : stamped.pose.matrix().reshaped()) out.push_back(value);
    }
    return out;
  }
  static std::vector<double> inTurn(const std::vector<Record>& records, std::size_t count) {
    const auto slam = newRun();
    for (std::size_t i = 0; i < count; ++i) slam->process(records[i]);
    return outcome(*slam);
  }
  /// Runs `count` records, each after it and those behind it were foreseen.
  static void run(SemanticSlam& slam, const std::vector<Record>& records, std::size_t count) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (; seen < std::min(i + kAhead, records.size()); ++seen) slam.foresee(records[seen]);
      slam.process(records[i]);
    }
  }
};

TEST_F(ScansAheadTest, GiveTheSameBitsAsInTheirTurn) {
  for (const double images_from : {1e300, 1.95}) {
    const auto records = lap(images_from);
    const auto slam = newRun();
    run(*slam, records, records.size());
    EXPECT_EQ(outcome(*slam), inTurn(records, records.size())) << images_from;
  }
}

// A pause in which it was carried to another place while the wheels stood: they predict nothing, ahead neither.
TEST_F(ScansAheadTest, WheelsThatStoodInAPausePredictNothing) {
  Drive drive;
  std::vector<Record> records;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i, later = i < 20 ? 0 : 10;
    OdometryReading reading = drive.odometry(i < 20 ? t : t - 0.1);
    reading.t = t + later;
    Scan scan = castScan(i < 20 ? asymmetricRoom() : boxAt(-9, -9, 19, 17), Drive::truth(t), t + later + 0.02, drive.random, 0.01, 720);
    records.emplace_back(reading);
    records.emplace_back(std::move(scan));
  }
  const auto slam = newRun(), turn = newRun();
  run(*slam, records, records.size());
  for (const Record& record : records) turn->process(record);
  const auto segments = [](const SemanticSlam& of) {
    const Trajectory path = of.setup().stages.scan_matcher->trajectory();
    return path.segment(path.size() - 1) - path.segment(0);
  };
  EXPECT_EQ(segments(*turn), 1) << "it begins anew";
  EXPECT_EQ(segments(*slam), 1);
  EXPECT_EQ(outcome(*slam), outcome(*turn));
}

TEST_F(ScansAheadTest, AreMatchedUntilAnImageComes) {
  const auto records = lap(1.95);
  const auto slam = newRun();
  std::size_t seen = 0;
  for (; !std::holds_alternative<Frame>(records[seen]); ++seen) slam->foresee(records[seen]);
  EXPECT_EQ(matched(*slam), 20u) << "ten in a second; late and broken ones are left out";
  for (; seen < records.size(); ++seen) slam->foresee(records[seen]);
  EXPECT_EQ(matched(*slam), 20u);
}

TEST_F(ScansAheadTest, ThatNeverHaveTheirTurnChangeNothing) {
  const auto records = lap();
  const std::size_t count = records.size() / 2;
  const auto slam = newRun();
  run(*slam, records, count);
  const std::size_t matched_ahead = matched(*slam);
  EXPECT_EQ(outcome(*slam), inTurn(records, count));
  const auto slam_in_turn = newRun();
  for (std::size_t i = 0; i < count; ++i) slam_in_turn->process(records[i]);
  EXPECT_GT(matched_ahead, matched(*slam_in_turn)) << "the test is about nothing";
}

}  // namespace
}  // namespace roomgraph::test
