// SPDX-License-Identifier: BSD-3-Clause
// Leg line, vanishing points, cuboid corners and edge agreement on rendered scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "cuboid_corners.h"
#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "edge_agreement.h"
#include "leg_line.h"
#include "roomgraph/core/order_statistics.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

/// Evidence from the shaded image alone.
BoxEvidence blindEvidence(const Scene& scene, const std::string& class_name) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  frame.depth = cv::Mat();
  return gatherEvidence(frame, test::detectionOf(1, labels, class_name), *database().find(class_name),
                        groundInCamera(scene.world_from_camera));
}

PlacedShape sofaAt(double x, double y, double yaw) {
  PlacedShape placed;
  placed.shape = {ShapeKind::kCuboid, 1.8, 0.88, 0.82};
  placed.x = x;
  placed.y = y;
  placed.yaw = yaw;
  return placed;
}

TEST(LegLine, SlantedLegIsExtendedToTheBottom) {
  const Box2 box{60, 50, 140, 200};
  const LegLine leg = findLeg({{{98, 150}, {99, 190}}, {{62, 60}, {62, 195}}, {{80, 190}, {120, 192}}}, box);
  ASSERT_TRUE(leg.column);
  EXPECT_NEAR(*leg.column, 99.25, 1e-9);
  // Both sides of the tube: the middle, weighted by length.
  const LegLine tube = findLeg({{{97, 150}, {97, 190}}, {{103, 150}, {103, 190}}}, box);
  ASSERT_TRUE(tube.column);
  EXPECT_NEAR(*tube.column, 100, 1e-9);
}

TEST(LegLine, IllConditionedLinesOnlyVote) {
  const Box2 box{60, 50, 140, 200};
  const LegLine feet = findLeg({{{90, 170}, {80, 190}}, {{110, 170}, {120, 190}}}, box);
  EXPECT_FALSE(feet.column);
  ASSERT_EQ(feet.votes.size(), 2u);
  EXPECT_NEAR(feet.votes[0], 75, 1e-9);
  EXPECT_NEAR(feet.votes[1], 125, 1e-9);
  EXPECT_FALSE(findLeg({{{100, 128}, {100, 145}}}, box).column);  // too far to extend
  EXPECT_TRUE(findLeg({}, box).votes.empty());
}

// Something hides the left third of the chair and something touches its right side: neither side of the box is the
// chair's. The middle of what is left is off to the right, the leg is not.
TEST(LegLine, PlacesAChairWhoseSidesAreHidden) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addCylinder(2.5, 0.3, 0.31, 0.95, 1);
  BoxEvidence e = blindEvidence(scene, "swivel_chair");
  const double truth =
      e.camera.project((scene.world_from_camera.inverse() * Eigen::Vector3d(2.5, 0.3, 0))).x();
  e.box.u_min += 0.35 * e.box.width();
  e.cut.left = e.cut.right = true;
  const auto error = [](const PlacedShape& p) { return std::hypot(p.x - 2.5, p.y - 0.3); };
  const auto bestError = [&](const std::vector<Segment2>& segments) {
    e.segments = segments;
    double best = 1e9;
    for (const auto& p : test::hypotheses<CylinderGenerator>(e)) best = std::min(best, error(p));
    return best;
  };
  const auto legAt = [&](double u) { return Segment2{{u, e.box.v_max - 40}, {u, e.box.v_max - 8}}; };
  EXPECT_GT(bestError({}), 0.09);
  EXPECT_LT(bestError({legAt(truth)}), 0.06) << "one of the hypotheses stands above the leg";
  EXPECT_GT(bestError({legAt(truth + 25)}), 0.09) << "a leg elsewhere is of no help";
}

TEST(Vanishing, ParallelEdgesMeetThere) {
  Scene scene;
  scene.lookAhead(1.2, 0.3, 0.1);
  BoxEvidence e;
  e.camera = scene.camera;
  e.ground = groundInCamera(scene.world_from_camera);
  e.camera_from_ground = cameraFromGround(e.ground);
  const PlacedShape sofa = sofaAt(2.5, 0.2, 0.7);
  const auto points = vanishingPoints(sofa, e);
  const Pose3 pose = cameraFromObject(sofa, e);
  for (int axis = 0; axis < 3; ++axis)
    for (const double offset : {0.0, 0.4}) {
      Eigen::Vector3d a = Eigen::Vector3d::Constant(offset), b = a;
      b[axis] += 0.5;
      const Eigen::Vector3d line =
          e.camera.project(pose * a).homogeneous().cross(e.camera.project(pose * b).homogeneous());
      EXPECT_NEAR(line.normalized().dot(points[axis].normalized()), 0, 1e-9);
    }
}

// Boxes of exactly projected cuboids, seen from below and from above their top.
TEST(Vanishing, CornersRecoverCuboids) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> range(2.2, 3.4), side(-0.15, 0.15), turn(-1.0, 1.0);
  for (const auto& [height, pitch] : {std::pair{0.75, 0.2}, std::pair{1.5, 0.45}})
    for (int run = 0; run < 10; ++run) {
      Scene scene;
      scene.lookAhead(height, pitch);
      BoxEvidence e;
      e.camera = scene.camera;
      e.ground = groundInCamera(scene.world_from_camera);
      e.camera_from_ground = cameraFromGround(e.ground);
      e.model = database().find("sofa");
      const double x = range(random), y = side(random) * x;
      const PlacedShape truth = sofaAt(x, y, wrapAngle(std::numbers::pi + std::atan2(y, x) + turn(random)));
      const auto projected = project(truth, e);
      ASSERT_TRUE(projected);
      if (projected->cut.left || projected->cut.right || projected->cut.bottom) continue;
      e.box = projected->visible;
      double best = 0;
      for (const PlacedShape& p : cuboidsFromCorners(e))
        best = std::max(best, iou3d(p.shape, groundFromObject(p), truth.shape, groundFromObject(truth)));
      EXPECT_GT(best, 0.6) << "height " << height << " run " << run;
    }
}

TEST(EdgeAgreement, IsHighestAtTheTruth) {
  Scene scene;
  scene.lookAhead(1.1, 0.3);
  scene.addBox(2.6, 0.1, 2.6, 1.8, 0.88, 0, 0.82, 1);
  BoxEvidence e = blindEvidence(scene, "sofa");
  ASSERT_FALSE(e.edges.distance.empty());
  const double truth = edgeAgreement(sofaAt(2.6, 0.1, 2.6), e).value();
  EXPECT_GT(truth, 0.6);
  for (const double shift : {-0.4, 0.4}) {
    EXPECT_GT(truth, edgeAgreement(sofaAt(2.6 + shift, 0.1, 2.6), e).value() + 0.05);
    EXPECT_GT(truth, edgeAgreement(sofaAt(2.6, 0.1 + shift, 2.6), e).value() + 0.05);
    EXPECT_GT(truth, edgeAgreement(sofaAt(2.6, 0.1, 2.6 + shift), e).value() + 0.05);
  }
  e.edges = {};
  EXPECT_FALSE(edgeAgreement(sofaAt(2.6, 0.1, 2.6), e));
}

TEST(Cuboid, WithoutDepthEdgesGivePlaceAndDirection) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> range(2.3, 3.3), side(-0.15, 0.15), turn(-0.9, 0.9);
  std::vector<double> centre, yaw;
  for (int run = 0; run < 12; ++run) {
    Scene scene;
    scene.lookAhead(0.8, 0.2);
    const double x = range(random), y = side(random) * x;
    const double front = std::numbers::pi + std::atan2(y, x) + turn(random);
    scene.addSofa(x, y, front, 1.8, 0.88, 0.82, 1);
    const auto found = test::hypotheses<CuboidGenerator>(blindEvidence(scene, "sofa"));
    ASSERT_FALSE(found.empty());
    centre.push_back(std::hypot(found[0].x - x, found[0].y - y));
    yaw.push_back(std::abs(wrapAngle(found[0].yaw - front)));
  }
  EXPECT_LT(quantile(centre, 0.5), 0.25);
  EXPECT_LT(quantile(yaw, 0.5), 0.25);
}

// The expected ground is wrong by more than a degree: the usual size contradicts, and part of it is
// corrected.
TEST(Cylinder, WithoutDepthTheLocalGroundIsCorrected) {
  for (const double wrong : {-0.025, 0.025}) {
    Scene scene;
    scene.lookAhead(0.8, 0.2);
    scene.addCylinder(3.0, 0.2, 0.31, 0.95, 1);
    BoxEvidence e = blindEvidence(scene, "swivel_chair");
    e.ground.normal = (expSO3({wrong, 0, 0}) * e.ground.normal).eval();
    e.camera_from_ground = cameraFromGround(e.ground);
    const auto error = [&](double sigma) {
      e.ground_tilt_sigma = sigma;
      const auto found = test::hypotheses<CylinderGenerator>(e);
      if (found.empty()) return 1e9;
      const Pose3 pose = scene.world_from_camera * cameraFromObject(found[0], e);
      return (pose.translation().head<2>() - Eigen::Vector2d(3.0, 0.2)).norm();
    };
    EXPECT_LT(error(0.02), error(0)) << wrong;
    EXPECT_LT(error(0.02), 0.25) << wrong;
  }
}

}  // namespace
}  // namespace roomgraph
