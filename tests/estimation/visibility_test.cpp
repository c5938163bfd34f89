// SPDX-License-Identifier: BSD-3-Clause
// Evidence of lidar beams for and against a landmark.
#include "visibility.h"

#include <gtest/gtest.h>

#include <cmath>

namespace roomgraph::test {
namespace {

// Beams straight ahead and some degrees beside, all of one length.
Scan beams(double range_m, double height_m = 0.25) {
  Scan scan;
  for (int i = -10; i <= 10; ++i) {
    scan.ranges_m.push_back(static_cast<float>(range_m));
    scan.valid.push_back(1);
  }
  scan.angle_min_rad = -10 * M_PI / 180;
  scan.angle_step_rad = M_PI / 180;
  scan.max_range_m = 12;
  scan.robot_from_lidar.translation().z() = height_m;
  return scan;
}

constexpr double kSofa = 0.4, kOpen = 0;  // share of the height that is solid

Landmark objectAhead(ShapeKind kind = ShapeKind::kCuboid) {
  Landmark landmark;
  landmark.shape = {kind, 0.8, 0.8, 0.8};
  landmark.position = {3, 0, 0};
  return landmark;
}

RayEvidence raysAt(const Landmark& landmark, const Scan& scan, const Pose3& world_from_robot, double solid_share) {
  return rayEvidence(landmark.shape, landmark.worldFromObject(), scan, world_from_robot, solid_share);
}

TEST(RayEvidence, ALidarWhoseRangeIsNotKnownCountsAsOneThatReachesFar) {
  for (const double range_m : {0.0, 30.0, 1.0}) {
    Scan scan = beams(3.0);
    scan.max_range_m = range_m;
    EXPECT_EQ(raysAt(objectAhead(), scan, Pose3::Identity(), kSofa).inside, range_m == 1 ? 0 : 15) << range_m;
  }
}

TEST(RayEvidence, CountsBeamsThatEndInsideOrGoThroughTheMiddle) {
  const Landmark sofa = objectAhead();
  const RayEvidence inside = raysAt(sofa, beams(3.0), Pose3::Identity(), kSofa);
  // Ends at 3 m within .4 m to the side: asin(.4 / 3) = 7.7 degrees.
  EXPECT_EQ(inside.inside, 15);
  EXPECT_EQ(inside.through, 0);
  const RayEvidence behind = raysAt(sofa, beams(6.0), Pose3::Identity(), kSofa);
  EXPECT_EQ(behind.inside, 0);
  // Pass within .2 m of the middle: asin(.2 / 3) = 3.8 degrees.
  EXPECT_EQ(behind.through, 7);
  const RayEvidence before = raysAt(sofa, beams(1.0), Pose3::Identity(), kSofa);
  EXPECT_EQ(before.inside + before.through, 0) << "something hides it";
}

TEST(RayEvidence, MovesWithTheRobot) {
  const Pose3 world_from_robot = poseFromYpr(3, -3, 0, M_PI / 2, 0, 0);
  EXPECT_EQ(raysAt(objectAhead(), beams(3.0), world_from_robot, kSofa).inside, 15);
  const Pose3 away = poseFromYpr(3, -3, 0, -M_PI / 2, 0, 0);
  EXPECT_EQ(raysAt(objectAhead(), beams(6.0), away, kSofa).through, 0)
      << "looks the other way";
}

TEST(RayEvidence, NothingGoesAgainstWhatIsNotSolid) {
  for (const auto kind : {ShapeKind::kCylinder, ShapeKind::kCuboid, ShapeKind::kPlanar}) {
    EXPECT_EQ(raysAt(objectAhead(kind), beams(6.0), Pose3::Identity(), kOpen).through, 0);
    EXPECT_EQ(raysAt(objectAhead(kind), beams(6.0), Pose3::Identity(), kSofa).through, 7) << "whatever its shape";
  }
  EXPECT_EQ(raysAt(objectAhead(), beams(3.0), Pose3::Identity(), kOpen).inside, 15);
  EXPECT_EQ(raysAt(objectAhead(), beams(6.0, 0.5), Pose3::Identity(), kSofa).through, 0)
      << "over the seat";
  EXPECT_EQ(raysAt(objectAhead(), beams(3.0, 1.2), Pose3::Identity(), kSofa).inside, 0)
      << "over all of it";
  Landmark lamp = objectAhead();
  lamp.position.z() = 1.5;
  EXPECT_EQ(raysAt(lamp, beams(3.0), Pose3::Identity(), kSofa).inside, 0) << "below all of it";
}

}  // namespace
}  // namespace roomgraph::test
