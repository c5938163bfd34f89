// SPDX-License-Identifier: BSD-3-Clause
// Measured shapes against the latest scan: beams that stop in them, or pass through.
#include <gtest/gtest.h>

#include <cmath>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/estimation/object_mapper.h"
#include "shipped_objects.h"
#include "still_camera.h"

namespace roomgraph::test {
namespace {

class ScanDoubt : public ::testing::Test {
 protected:
  ScanDoubt() : mapper_(nearestNeighbor(), {}, 0.03, poses_) { poses_.add(0, Pose3::Identity()); }

  static std::shared_ptr<Associator> nearestNeighbor() {
    association::registerClasses();
    return createStage<Associator>("NearestNeighborAssociator", "test");
  }
  // Everything straight ahead (30 degrees to both sides) is `range_m` away.
  void scan(double range_m, double t = 0, double height_m = 0.2) {
    Scan out;
    out.t = t;
    out.angle_min_rad = -M_PI / 6;
    out.angle_step_rad = M_PI / 360;
    out.max_range_m = 20;
    out.robot_from_lidar.translation().z() = height_m;
    out.ranges_m.assign(121, static_cast<float>(range_m));
    out.valid.assign(121, 1);
    mapper_.observe(out, Pose3::Identity(), shippedObjects());
  }
  // Score, of 0.8 before, of a shape of the class 3 m ahead that faces the robot.
  double scoreOf(const char* name) const {
    const Frame frame = frameAt(0, 0.1);
    std::vector<ObjectMeasurement> seen(1);
    Proposal& proposal = seen[0].proposal;
    proposal.class_name = proposal.model = name;
    proposal.shape = shippedObjects().find(name)->nominal();
    proposal.camera_from_object = frame.robot_from_camera.inverse() * poseFromYpr(3, 0, 0, M_PI, 0, 0);
    proposal.score = 0.8;
    mapper_.doubtByScan(seen, frame, shippedObjects());
    return proposal.score;
  }

  KeyPoses poses_{standing()};
  ObjectMapper mapper_;
};

TEST_F(ScanDoubt, NothingIsKnownWithoutAScan) {
  EXPECT_EQ(scoreOf("sofa"), 0.8);
}

TEST_F(ScanDoubt, BeamsThatStopInASofaSpeakForIt) {
  scan(2.7);
  EXPECT_EQ(scoreOf("sofa"), 0.8);
}

TEST_F(ScanDoubt, BeamsThatPassThroughSpeakAgainstItsPlace) {
  scan(6);
  EXPECT_NEAR(scoreOf("sofa"), 0.2 * 0.8, 1e-12);
}

TEST_F(ScanDoubt, BeamsBeforeItSayNothing) {
  scan(1.2);
  EXPECT_EQ(scoreOf("sofa"), 0.8) << "it is hidden";
}

TEST_F(ScanDoubt, BeamsPassBetweenLegsAndOverSeats) {
  scan(6);
  EXPECT_EQ(scoreOf("swivel_chair"), 0.8);
  EXPECT_EQ(scoreOf("door"), 0.8) << "it is open";
  scan(6, 0.05, 0.6);
  EXPECT_EQ(scoreOf("sofa"), 0.8) << "over its seat";
}

TEST_F(ScanDoubt, AnOldScanSaysNothing) {
  scan(6, -0.5);
  EXPECT_EQ(scoreOf("sofa"), 0.8);
}

}  // namespace
}  // namespace roomgraph::test
