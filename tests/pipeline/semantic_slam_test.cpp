// SPDX-License-Identifier: BSD-3-Clause
// SemanticSlam in a simulated room: accuracy, map, single sources, late records.
#include "roomgraph/pipeline/semantic_slam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive.h"

namespace roomgraph::test {
namespace {

const std::string kLidarOnly = "[tracking]\nenabled = false\n[detection]\nenabled = false\n";

class Recorder : public Sink {
 public:
  void onStep(const StepReport& report) override {
    if (report.kind != StepReport::Kind::kOther) live.push_back({report.t, report.world_from_robot});
  }
  std::vector<StampedPose> live;
};

void drive(SemanticSlam& slam, double until_s = Drive::kLap_s) {
  Drive world;
  for (int i = 0; 0.1 * i <= until_s; ++i) {
    slam.process(world.odometry(0.1 * i));
    slam.process(world.scan(0.1 * i));
  }
}

struct Errors {
  double offset_m =
      0;  ///< of the whole trajectory: the first scan alone fixes the world, rounded to cells of 5 cm
  double rms_m = 0, largest_rad = 0;  ///< what is left
};

Errors errorsOf(const std::vector<StampedPose>& poses) {
  Errors out;
  const double share = 1.0 / static_cast<double>(poses.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& stamped : poses)
    mean += share * (stamped.pose.translation() - toPose3(Drive::truth(stamped.t)).translation());
  for (const auto& stamped : poses) {
    const Pose3 truth = toPose3(Drive::truth(stamped.t));
    out.rms_m += share * (stamped.pose.translation() - truth.translation() - mean).squaredNorm();
    out.largest_rad = std::max(out.largest_rad, rotationAngle(truth.inverse() * stamped.pose));
  }
  out.offset_m = mean.norm();
  out.rms_m = std::sqrt(out.rms_m);
  return out;
}

TEST(SemanticSlam, PosesTooFarApartForAGridCostTheGridOnly) {
  SemanticSlam slam(setupWith(kLidarOnly + "[mapping]\nresolution_m = 0.005\n"));
  Drive world;
  // Another room all at once: the wheels alone say how it got there, and they are wrong by 300 m.
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i, far = i < 15 ? 0 : 300;
    slam.process(OdometryReading{t, {far, far, 0}});
    slam.process(castScan(i < 15 ? asymmetricRoom() : boxAt(-9, -9, 19, 17), {}, t, world.random, 0.01, 720));
  }
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.world_from_robot.size(), 40u);
  EXPECT_FALSE(result.map.occupancy);
  int named = 0;
  for (const auto& [reason, count] : result.counts.reasons)
    named += reason.find("occupancy grid: the poses spread over") != std::string::npos;
  EXPECT_EQ(named, 1);
}

// A camera that is started late and stops early: wheels tell the rest of the way.
TEST(SemanticSlam, WheelsGoOnWhereNothingElseIs) {
  SemanticSlam slam(setupWith(kLidarOnly));
  Drive world;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.1 * i;
    slam.process(world.odometry(t));
    slam.process(world.odometry(t + 0.05));
    if (t > 3.95 && t < 8.05 && (t < 5.05 || t > 6.45)) slam.process(world.scan(t + 0.06));
  }
  EXPECT_GT(slam.keyPoses().nodes().back().t, 11) << "at once, not only in the end";
  const SlamResult result = slam.finish();
  ASSERT_FALSE(result.world_from_robot.empty());
  EXPECT_NEAR(result.world_from_robot.front().t, 0, 1e-9);
  EXPECT_NEAR(result.world_from_robot.back().t, 12.05, 0.1);
  double longest_s = 0;
  for (std::size_t i = 1; i < result.world_from_robot.size(); ++i)
    longest_s = std::max(longest_s, result.world_from_robot[i].t - result.world_from_robot[i - 1].t);
  EXPECT_LT(longest_s, 1.6) << "up to a second and a half are left to scans";
  EXPECT_LT(result.world_from_robot.size(), 160u) << "ten poses of wheels a second at most";
  // Wheels that turn 6 % too far, over eight seconds.
  EXPECT_LT((result.world_from_robot.back().pose.translation() - result.world_from_robot.front().pose.translation()).norm(), 0.6);
}

TEST(SemanticSlam, LapThroughARoomIsFoundToACentimetre) {
  SemanticSlam slam(setupWith(kLidarOnly));
  const auto recorder = std::make_shared<Recorder>();
  slam.addSink(recorder);
  drive(slam);
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.scans, 121);
  EXPECT_EQ(result.counts.scans_unmatched, 0);
  EXPECT_EQ(result.counts.odometry, 121);
  EXPECT_EQ(result.world_from_robot.size(), 121u);
  const Errors final = errorsOf(result.world_from_robot), live = errorsOf(recorder->live);
  EXPECT_LT(final.offset_m, 0.03);
  EXPECT_LT(final.rms_m, 0.01);
  EXPECT_LT(final.largest_rad, 0.01);
  EXPECT_LT(live.rms_m, 0.012);
  EXPECT_TRUE(result.map.planar);
  EXPECT_GE(slam.graph().poses(), 30u);
}

TEST(SemanticSlam, MapHasTheWallsAndTheFreeSpace) {
  SemanticSlam slam(setupWith(kLidarOnly));
  drive(slam);
  const SlamResult result = slam.finish();
  ASSERT_TRUE(result.map.occupancy);
  const auto& grid = *result.map.occupancy;
  EXPECT_GT(grid.getPos(0.0f, 1.0f), 0.8) << "free inside";
  // Walls of the room, in world (the first pose is the room's origin): x = 5 and y = -2.
  const auto occupiedNear = [&](double x, double y) {
    float least = 1;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        least =
            std::min(least, grid.getPos(static_cast<float>(x + 0.05 * i), static_cast<float>(y + 0.05 * j)));
    return least < 0.4f;
  };
  EXPECT_TRUE(occupiedNear(5, 1));
  EXPECT_TRUE(occupiedNear(1, -2));
  EXPECT_TRUE(occupiedNear(-3, 0));
}

// What the matcher does not use is not drawn either.
TEST(SemanticSlam, NoiseIsNotDrawnIntoTheMap) {
  int occupied[2] = {}, unmatched[2] = {};
  for (const bool noisy : {false, true}) {
    SemanticSlam slam(setupWith(kLidarOnly));
    Drive world;
    std::normal_distribution<float> noise(0, 0.3f);
    for (int i = 0; i <= 160; ++i) {
      const double t = std::min(0.1 * i, Drive::kLap_s);  // it stands in the end
      OdometryReading reading = world.odometry(t);
      Scan scan = castScan(asymmetricRoom(), Drive::truth(t), 0.1 * i, world.random, 0.01, 720);
      reading.t = scan.t;
      if (noisy && i > 121)
        for (auto& range : scan.ranges_m) range += noise(world.random);
      slam.process(reading);
      if (noisy || i <= 121) slam.process(scan);
    }
    const SlamResult result = slam.finish();
    unmatched[noisy] = result.counts.scans_unmatched;
    for (unsigned y = 0; y < result.map.occupancy->getSizeY(); ++y)
      for (unsigned x = 0; x < result.map.occupancy->getSizeX(); ++x)
        occupied[noisy] += result.map.occupancy->getCell(static_cast<int>(x), static_cast<int>(y)) < 0.4f;
  }
  EXPECT_EQ(unmatched[0], 0);
  EXPECT_GT(unmatched[1], 30);
  EXPECT_GT(occupied[0], 300);
  EXPECT_EQ(occupied[1], occupied[0]);
}

TEST(SemanticSlam, WheelsAloneAreAsGoodAsTheWheels) {
  SemanticSlam slam(setupWith(kLidarOnly + "[lidar]\nenabled = false\n"));
  Drive world;
  for (int i = 0; i <= 60; ++i) {
    slam.process(world.odometry(0.1 * i));
    slam.process(Drive::frame(0.1 * i));
  }
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.frames, 61);
  for (const auto& stamped : result.world_from_robot)
    EXPECT_LT((stamped.pose.translation() - toPose3(world.odometry(stamped.t).odom_from_robot).translation())
                  .norm(),
              1e-3);
  ASSERT_EQ(result.world_from_camera.size(), 61u);
  EXPECT_TRUE(result.world_from_camera[0].pose.isApprox(Drive::robotFromCamera(), 1e-6));
}

TEST(SemanticSlam, ScansAloneWillDo) {
  SemanticSlam slam(setupWith(kLidarOnly + "[odometry]\nenabled = false\n"));
  drive(slam, 6);
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.odometry, 0);
  EXPECT_LT(errorsOf(result.world_from_robot).rms_m, 0.015);
}

TEST(SemanticSlam, RecordsThatGoBackInTimeAreCountedAndLeftOut) {
  SemanticSlam slam(setupWith(kLidarOnly));
  Drive world;
  slam.process(world.scan(1));
  slam.process(world.scan(0.5));
  slam.process(world.scan(1));
  slam.process(world.scan(1.1));
  const SlamResult result = slam.finish();
  EXPECT_EQ(result.counts.scans, 2);
  EXPECT_EQ(result.world_from_robot.size(), 2u);
  EXPECT_THAT(result.counts.reasons, ::testing::Contains(::testing::Pair(::testing::HasSubstr("scans"), 2)));
}

TEST(SemanticSlam, NothingInNothingOut) {
  SemanticSlam slam(setupWith(kLidarOnly));
  const SlamResult result = slam.finish();
  EXPECT_TRUE(result.world_from_robot.empty());
  EXPECT_TRUE(result.map.landmarks.empty());
  EXPECT_EQ(result.map.occupancy, nullptr);
}

TEST(SemanticSlam, FinishMayBeCalledAtAnyMoment) {
  SemanticSlam slam(setupWith(kLidarOnly)), same(setupWith(kLidarOnly));
  drive(slam, 3);
  drive(same, 3);
  const SlamResult first = slam.finish(), second = same.finish();
  ASSERT_EQ(first.world_from_robot.size(), second.world_from_robot.size());
  for (std::size_t i = 0; i < first.world_from_robot.size(); ++i)
    EXPECT_TRUE(first.world_from_robot[i].pose.matrix() == second.world_from_robot[i].pose.matrix()) << i;
}

}  // namespace
}  // namespace roomgraph::test
