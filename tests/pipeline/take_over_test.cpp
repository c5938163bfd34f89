// SPDX-License-Identifier: BSD-3-Clause
// What the graph beside the run has found reaches landmarks as it reaches poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <map>

#include "drive.h"
#include "fake_stages.h"

namespace roomgraph::test {
namespace {

constexpr double kSpacing_rad = 0.33, kError_m = 0.25;

// Chairs all around, of which each new key pose shows another, and images that err by centimetres a step.
class TakeOverTest : public ::testing::Test {
 protected:
  TakeOverTest() {
    registerAllClasses();
    fakes::registerClasses();
    fakes::world() = {};
    fakes::world().world_from_camera = [](double t) { return toPose3(Drive::truth(t)) * Drive::robotFromCamera(); };
    fakes::world().step_covariance = 1e-3 * Matrix6d::Identity();
    for (double angle = 0; angle < 2 * M_PI; angle += kSpacing_rad)
      fakes::world().objects.push_back({"swivel_chair",
                                        {ShapeKind::kCylinder, 0.6, 0.6, 0.9},
                                        poseFromYpr(4 * std::cos(angle), 1.1 + 4 * std::sin(angle), 0, 0, 0, 0)});
    slam_ = std::make_unique<SemanticSlam>(setupWith(
        "[detection]\nclass = FakeDetector\n[proposals]\nclass = FakeProposals\n[existence]\nenabled = false\n"
        "[tracking]\nclass = FakeOdometry\n[lidar]\nenabled = false\n[odometry]\nenabled = false\n"
        "[backend]\nlocal_map_nodes = 0\n[object_loop_closing]\nenabled = false\n[landmarks]\ndoubt_by_scan = false\n"));
  }

  void see(double t) { slam_->process(Drive::frame(t)); }

  // Where the last sighting of each landmark puts it, as the key poses are now.
  std::map<LandmarkId, Eigen::Vector3d> lastSeen() const {
    std::map<LandmarkId, Eigen::Vector3d> out;
    for (const ObjectFrame& frame : slam_->objects().frames())
      for (const ObjectDecision& decision : frame.decisions)
        out[decision.landmark] = (slam_->keyPoses().at(frame.t) * frame.robot_from_camera *
                                  decision.seen.measurement.proposal.camera_from_object)
                                     .translation();
    return out;
  }

  std::unique_ptr<SemanticSlam> slam_;
};

// Late word of a loop far back: no window of poses holds it.
TEST_F(TakeOverTest, LandmarksGoWithThePoses) {
  double t = 0;
  std::vector<fakes::WorldObject> chairs;
  std::swap(chairs, fakes::world().objects);
  for (; t < 5; t += 0.1) see(t);  // no landmark holds the path together
  std::swap(chairs, fakes::world().objects);
  for (; t < 7; t += 0.1) see(t);
  const auto& camera = fakes::world().world_from_camera;
  RelativePose closure{0.5, 4.5, camera(0.5).inverse() * poseFromYpr(0, kError_m, 0, 0, 0, 0) * camera(4.5),
                       25e-4 * Matrix6d::Identity()};
  closure.source = "test";
  fakes::world().closures = {closure};
  const Eigen::Vector3d before = slam_->keyPoses().at(5).translation();
  const auto moved_m = [&] { return (slam_->keyPoses().at(5).translation() - before).norm(); };
  const auto& landmarks = slam_->objects().landmarks().landmarks();
  std::set<LandmarkId> known;  // when the graph that heeds the closure was begun, or before
  for (const Landmark& landmark : landmarks) known.insert(landmark.id);
  while (t < 11 && moved_m() < kError_m / 2) see(t += 0.1);
  ASSERT_GT(moved_m(), kError_m / 2);
  ASSERT_TRUE(std::any_of(landmarks.begin(), landmarks.end(), [&known](const Landmark& landmark) {
    return !known.contains(landmark.id);
  })) << "none was found since";
  for (const Landmark& landmark : landmarks)
    EXPECT_LT((lastSeen().at(landmark.id) - landmark.position).head<2>().norm(), 0.02) << "landmark " << landmark.id;
}

}  // namespace
}  // namespace roomgraph::test
