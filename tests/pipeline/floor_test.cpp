// SPDX-License-Identifier: BSD-3-Clause
// A handheld camera finds its floor, waits for it, and gets over a table top that was taken for it.
#include <gtest/gtest.h>

#include <cmath>

#include "drive.h"
#include "fake_stages.h"

namespace roomgraph::test {
namespace {

constexpr double kTable_m = 0.72, kLastFrame_s = 8;

Pose3 handheld(double t) {
  Pose3 pose = poseFromYpr(0.3 * t, 0.1 * std::sin(t), 1.3 + 0.05 * std::sin(2 * t), 0.2 * t,
                           0.4 + 0.1 * std::sin(t), 0.1 * std::cos(t));
  pose.linear() = pose.linear() * bodyFromOptical();
  return pose;
}

class FloorOfAHandheldCamera : public ::testing::Test {
 protected:
  FloorOfAHandheldCamera() {
    registerAllClasses();
    fakes::registerClasses();
    fakes::world() = {};
    fakes::world().world_from_camera = handheld;
  }
  /// Frames at 10 Hz; `look` sees each step.
  template <class Look>
  SlamResult run(const std::function<double(double)>& height, const Look& look) {
    struct Watch : Sink {
      explicit Watch(const Look& l) : look(l) {}
      void onStep(const StepReport& step) override { look(step); }
      const Look& look;
    };
    fakes::world().plane_height = height;
    SemanticSlam slam(
        setupWith("[detection]\nenabled = false\n[ground]\nclass = FakeFloors\n[tracking]\n"
                  "class = FakeOdometry\n[lidar]\nenabled = false\n"));
    slam.addSink(std::make_shared<Watch>(look));
    for (double t = 0; t < kLastFrame_s; t += 0.1) {
      if (t > gap_.first && t < gap_.second) continue;
      Frame frame = Drive::frame(t);
      frame.robot_from_camera = Pose3::Identity();
      slam.process(frame);
    }
    return slam.finish();
  }
  static void expectLevel(const SlamResult& result) {
    ASSERT_GT(result.world_from_camera.size(), 70u);
    for (const auto& [t, pose] : result.world_from_camera) {
      EXPECT_NEAR(pose.translation().z(), handheld(t).translation().z(), 0.01) << t;
      const Plane up = groundInCamera(pose), truth = groundInCamera(handheld(t));
      EXPECT_LT((up.normal - truth.normal).norm(), 0.01) << t;
    }
  }
  std::pair<double, double> gap_{1e300, 1e300};  ///< without frames
  static constexpr const char* kWrong = "ground: what was taken for the floor was none";
};

TEST_F(FloorOfAHandheldCamera, IsBelievedAfterAFewFrames) {
  std::vector<bool> known;
  const auto result =
      run([](double) { return 0; },
          [&](const StepReport& step) { known.push_back(step.proposals && step.proposals->ground); });
  ASSERT_GT(known.size(), 10u);
  EXPECT_FALSE(known[0] || known[1]);
  EXPECT_TRUE(known[3]);
  expectLevel(result);
  EXPECT_EQ(result.counts.reasons.count(kWrong), 0u);
}

TEST_F(FloorOfAHandheldCamera, IsFoundBelowATableThatWasTakenForIt) {
  double levelled_by_table = -1;
  const auto result =
      run([](double t) { return t < 5 ? kTable_m : 0; },
          [&](const StepReport& step) {
            if (step.proposals && step.proposals->ground && step.t < 5 && levelled_by_table < 0)
              levelled_by_table = step.t;
          });
  EXPECT_NEAR(levelled_by_table, 3, 0.15) << "so near below the camera a floor is rare";
  expectLevel(result);
  EXPECT_EQ(result.counts.reasons.count(kWrong), 1u);
}

TEST_F(FloorOfAHandheldCamera, StaysWhereItIsAboveTables) {
  const auto result = run([](double t) { return t < 2 || t > 7 ? 0 : kTable_m; }, [](const StepReport&) {});
  expectLevel(result);
  EXPECT_EQ(result.counts.reasons.count(kWrong), 0u);
}

// It is covered, tilted and goes on: what was right before is right still, and what comes after is levelled by the floor.
TEST_F(FloorOfAHandheldCamera, KeepsWhatWasLevelWhenItIsLostAndTilted) {
  gap_ = {3.95, 6.05};
  const auto tilted = [](double t) { return Pose3(handheld(t) * Eigen::AngleAxisd(t > 5 ? 0.4 : 0, Eigen::Vector3d::UnitX())); };
  fakes::world().world_from_camera = tilted;
  fakes::world().lost_at = 6;
  const auto result = run([](double) { return 0; }, [](const StepReport&) {});
  EXPECT_EQ(result.counts.reasons.at(kWrong), 1);
  int after = 0;
  for (const auto& [t, pose] : result.world_from_camera) {
    EXPECT_NEAR(pose.translation().z(), handheld(t).translation().z(), 0.03) << t;
    EXPECT_LT((groundInCamera(pose).normal - groundInCamera(tilted(t)).normal).norm(), 0.02) << t;
    after += t > 5;
  }
  EXPECT_GT(after, 15);
}

}  // namespace
}  // namespace roomgraph::test
