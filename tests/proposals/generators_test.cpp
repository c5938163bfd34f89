// SPDX-License-Identifier: BSD-3-Clause
// Cylinder, cuboid and door hypotheses on rendered scenes, with and without depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "door_generator.h"
#include "rectangle_fit.h"
#include "roomgraph/core/order_statistics.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;
using test::sceneAhead;

/// Evidence for object 1 of the scene, with the true ground. The ground frame then equals the world.
BoxEvidence evidenceOf(const Scene& scene, const std::string& class_name, bool with_depth = true) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  const Detection detection = test::detectionOf(1, labels, class_name);
  if (!with_depth) frame.depth = cv::Mat();
  return gatherEvidence(frame, detection, *database().find(class_name),
                        groundInCamera(scene.world_from_camera));
}

double yawError(double a, double b) {
  return std::abs(wrapAngle(a - b));
}

TEST(Cylinder, FoundAtRandomPlaces) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> range(1.2, 3.8), side(-0.45, 0.45), radius(0.27, 0.35);
  for (int run = 0; run < 12; ++run) {
    Scene scene = sceneAhead();
    const double x = range(random), y = side(random) * x, r = radius(random);
    scene.addCylinder(x, y, r, 0.93, 1);
    const auto found = test::hypotheses<CylinderGenerator>(evidenceOf(scene, "swivel_chair"));
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::hypot(found[0].x - x, found[0].y - y), 0.08) << "run " << run;
    EXPECT_NEAR(found[0].shape.radius(), r, 0.05);
    EXPECT_NEAR(found[0].shape.height, 0.93, 0.05);
    EXPECT_GT(found[0].box_iou, 0.85);
  }
}

TEST(Cylinder, CutByTheBorderOfTheImage) {
  for (const double y : {1.0, -1.0}) {
    Scene scene = sceneAhead();
    scene.addCylinder(1.75, y, 0.31, 0.95, 1);
    const BoxEvidence evidence = evidenceOf(scene, "swivel_chair");
    ASSERT_TRUE(y > 0 ? evidence.cut.left : evidence.cut.right);
    const auto found = test::hypotheses<CylinderGenerator>(evidence);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::hypot(found[0].x - 1.75, found[0].y - y), 0.15);
  }
}

TEST(Cylinder, WithoutDepthTheContactWithTheGroundPlacesIt) {
  Scene scene = sceneAhead();
  scene.addCylinder(2.5, 0.4, 0.31, 0.95, 1);
  const auto found = test::hypotheses<CylinderGenerator>(evidenceOf(scene, "swivel_chair", false));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].source, "contact");
  EXPECT_LT(std::hypot(found[0].x - 2.5, found[0].y - 0.4), 0.12);
}

TEST(Cylinder, WithoutDepthAndBottomTheSizePlacesIt) {
  Scene scene = sceneAhead();
  scene.addCylinder(1.3, 0, 0.25, 1.7, 1);
  const BoxEvidence evidence = evidenceOf(scene, "person", false);
  ASSERT_TRUE(evidence.cut.bottom);
  const auto found = test::hypotheses<CylinderGenerator>(evidence);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].source, "size");
  EXPECT_LT(std::hypot(found[0].x - 1.3, found[0].y), 0.2);
}

TEST(Cuboid, SofasAtRandomPlacesAndDirections) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> range(2.0, 3.4), side(-0.2, 0.2), turn(-1.1, 1.1);
  std::vector<double> centre, yaw, overlap;
  for (int run = 0; run < 15; ++run) {
    Scene scene = sceneAhead();
    const double x = range(random), y = side(random) * x;
    const double front = std::numbers::pi + std::atan2(y, x) + turn(random);
    scene.addSofa(x, y, front, 1.9, 0.9, 0.8, 1);
    const auto found = test::hypotheses<CuboidGenerator>(evidenceOf(scene, "sofa"));
    ASSERT_FALSE(found.empty());
    const PlacedShape& top = found[0];
    centre.push_back(std::hypot(top.x - x, top.y - y));
    yaw.push_back(yawError(top.yaw, front));
    overlap.push_back(iou3d({ShapeKind::kCuboid, 1.9, 0.9, 0.8}, toPose3(Pose2{x, y, front}), top.shape,
                            groundFromObject(top)));
  }
  EXPECT_LT(quantile(centre, 0.5), 0.12);
  EXPECT_LT(quantile(yaw, 0.5), 0.09);
  EXPECT_LT(quantile(yaw, 0.8), 0.2);
  EXPECT_GT(quantile(overlap, 0.5), 0.65);
}

TEST(Cuboid, SofaSeenFromBehindFacesAway) {
  Scene scene = sceneAhead();
  scene.addSofa(2.4, 0, 0.3, 1.9, 0.9, 0.78, 1);
  const auto found = test::hypotheses<CuboidGenerator>(evidenceOf(scene, "sofa"));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(yawError(found[0].yaw, 0.3), 0.2);
}

TEST(Cuboid, PartlyOutsideTheImage) {
  Scene scene = sceneAhead();
  scene.addSofa(2.2, 1.2, -2.6, 1.8, 0.88, 0.8, 1);
  const BoxEvidence evidence = evidenceOf(scene, "sofa");
  ASSERT_TRUE(evidence.cut.left);
  const auto found = test::hypotheses<CuboidGenerator>(evidence);
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.size(), 4u);
  EXPECT_LT(std::hypot(found[0].x - 2.2, found[0].y - 1.2), 0.3);
  EXPECT_LT(yawError(found[0].yaw, -2.6), 0.2);
}

TEST(Cuboid, WithoutDepthAHypothesisIsNear) {
  Scene scene = sceneAhead();
  scene.addSofa(2.6, 0.2, 3.0, 1.8, 0.88, 0.82, 1);
  const auto found = test::hypotheses<CuboidGenerator>(evidenceOf(scene, "sofa", false));
  ASSERT_FALSE(found.empty());
  double nearest = 1e9;
  for (const auto& p : found) nearest = std::min(nearest, std::hypot(p.x - 2.6, p.y - 0.2));
  EXPECT_LT(nearest, 0.25);
}

TEST(Door, ClosedAndHalfOpen) {
  for (const double yaw : {std::numbers::pi, std::numbers::pi - 0.6, std::numbers::pi + 0.8}) {
    Scene scene = sceneAhead();
    scene.addBox(3.0, 0.3, yaw, 0.9, 0.06, 0, 2.05, 1);
    const BoxEvidence evidence = evidenceOf(scene, "door");
    ASSERT_TRUE(evidence.cut.top);
    const auto found = test::hypotheses<DoorGenerator>(evidence);
    ASSERT_FALSE(found.empty()) << yaw;
    EXPECT_LT(std::hypot(found[0].x - 3.0, found[0].y - 0.3), 0.08) << yaw;
    EXPECT_LT(yawError(found[0].yaw, yaw), 0.05) << yaw;
    EXPECT_NEAR(found[0].shape.width, 0.9, 0.08);
  }
}

TEST(Door, CutByTheSideOfTheImageKeepsItsUsualWidth) {
  Scene scene = sceneAhead();
  scene.addBox(2.0, 1.2, std::numbers::pi, 0.9, 0.06, 0, 2.05, 1);
  const BoxEvidence evidence = evidenceOf(scene, "door");
  ASSERT_TRUE(evidence.cut.left);
  const auto found = test::hypotheses<DoorGenerator>(evidence);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(std::hypot(found[0].x - 2.0, found[0].y - 1.2), 0.1);
}

TEST(Evidence, ContactOfTheBottomSide) {
  Scene scene = sceneAhead();
  scene.addCylinder(2.5, 0, 0.31, 0.95, 1);
  BoxEvidence evidence = evidenceOf(scene, "swivel_chair", false);
  const auto contact = contactPoint(evidence);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->x(), 2.5 - 0.31, 0.05);  // the near rim
  EXPECT_NEAR(contact->y(), 0, 0.02);
  evidence.box.v_max = 60;  // above the horizon
  EXPECT_FALSE(contactPoint(evidence));
}

TEST(Rectangle, TwoSidesOfAnL) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(i * 0.04, 0);
  for (int i = 0; i <= 20; ++i) points.emplace_back(0, i * 0.04);
  const double yaw = 0.5;
  const Eigen::Rotation2Dd turn(yaw);
  for (auto& p : points) p = turn * p + Eigen::Vector2d(2, 1);
  const auto found = fitRectangles(points, {}, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].yaw, yaw, 0.04);
  EXPECT_NEAR(found[0].size_first, 1.6, 0.08);
  EXPECT_NEAR(found[0].size_second, 0.8, 0.08);
  EXPECT_TRUE(fitRectangles({}).empty());
}

TEST(Quantile, OfFewValues) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({4}, 0.9), 4);
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2}, 1.0), 3);
}

}  // namespace
}  // namespace roomgraph
