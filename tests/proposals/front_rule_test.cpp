// SPDX-License-Identifier: BSD-3-Clause
// What objects.ini says of a class: its front, and whether it rests on the ground.
#include <gtest/gtest.h>

#include <numbers>

#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "front_agreement.h"
#include "scene.h"

namespace roomgraph {
namespace {

using std::numbers::pi;
using test::Scene;
using test::sceneAhead;

ObjectDatabase furniture(const std::string& front) {
  return ObjectDatabase::fromText(
      "[cabinet]\nlabels = cabinet\nwidth_m = 0.9\ndepth_m = 0.45\nheight_m = 1.1\nwidth_sigma_m = 0.15\n"
      "depth_sigma_m = 0.06\nheight_sigma_m = 0.3\nfront = " + front +
      "\n[tv]\nlabels = tv\nwidth_m = 1.0\ndepth_m = 0.12\nheight_m = 0.6\nwidth_sigma_m = 0.2\nheight_sigma_m = 0.15\n"
      "rests_on_ground = false\n[lamp]\nlabels = lamp\nshape = cylinder\nwidth_m = 0.4\ndepth_m = 0.4\nheight_m = 0.3\n"
      "rests_on_ground = false\n");
}

BoxEvidence evidenceFor(const Scene& scene, const ObjectModel& model, bool with_depth = true) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  const Detection detection = test::detectionOf(1, labels, model.class_name);
  if (!with_depth) frame.depth = cv::Mat();
  return gatherEvidence(frame, detection, model, groundInCamera(scene.world_from_camera));
}

// A plain box tells its front by no high part. Turned by up to 80 degrees the front is still seen.
TEST(FrontRule, TheFrontOfACabinetIsTheSideThatIsSeen) {
  const ObjectDatabase database = furniture("near_side");
  for (const double turn : {0.0, 0.35, -0.35, 0.8, -0.8, 1.3, -1.3}) {
    Scene scene = sceneAhead();
    scene.addBox(2.4, 0.1, pi + turn, 0.9, 0.45, 0, 1.1, 1);
    const auto found = test::hypotheses<CuboidGenerator>(evidenceFor(scene, *database.find("cabinet")));
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::abs(wrapAngle(found[0].yaw - pi - turn)), 0.15) << turn;
    EXPECT_LT(std::hypot(found[0].x - 2.4, found[0].y - 0.1), 0.1) << turn;
  }
}

TEST(FrontRule, DecidesBetweenFrontAndBackOnly) {
  Scene scene = sceneAhead();
  scene.addBox(2.4, 0, pi, 0.9, 0.45, 0, 1.1, 1);
  for (const auto& [front, towards, away] :
       {std::tuple{"near_side", 1.0, -1.0}, std::tuple{"none", 0.0, 0.0}}) {
    const ObjectDatabase database = furniture(front);
    const BoxEvidence e = evidenceFor(scene, *database.find("cabinet"));
    PlacedShape placed = usualShape(e);
    placed.x = 2.4;
    placed.yaw = pi;
    EXPECT_NEAR(frontAgreement(placed, e), towards, 1e-12) << front;
    placed.yaw = 0;
    EXPECT_NEAR(frontAgreement(placed, e), away, 1e-12) << front;
  }
}

// A screen on a wall and a lamp on a desk: their depth points say how high they are.
TEST(Raised, WhatDoesNotRestOnTheGroundIsWhereItsPointsBegin) {
  const ObjectDatabase database = furniture("none");
  Scene scene = sceneAhead();
  scene.addBox(2.6, 0.2, pi, 1.0, 0.12, 0.75, 1.3, 1);
  const BoxEvidence screen = evidenceFor(scene, *database.find("tv"));
  const auto found = test::hypotheses<CuboidGenerator>(screen);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].z, 0.75, 0.04);
  EXPECT_NEAR(found[0].shape.height, 0.55, 0.06);
  EXPECT_LT(std::hypot(found[0].x - 2.6, found[0].y - 0.2), 0.1);
  EXPECT_GT(found[0].box_iou, 0.85);
  const Pose3 pose = scene.world_from_camera * cameraFromObject(found[0], screen);
  EXPECT_NEAR(pose.translation().z(), found[0].z, 1e-9);
  EXPECT_TRUE(test::hypotheses<CuboidGenerator>(evidenceFor(scene, *database.find("tv"), false)).empty())
      << "nothing tells its height without depth";

  Scene desk = sceneAhead();
  desk.addCylinder(2.0, -0.2, 0.2, 1.0, 1);
  desk.solids.back().low.z() = 0.7;
  const auto round = test::hypotheses<CylinderGenerator>(evidenceFor(desk, *database.find("lamp")));
  ASSERT_FALSE(round.empty());
  EXPECT_NEAR(round[0].z, 0.7, 0.03);
  EXPECT_LT(std::hypot(round[0].x - 2.0, round[0].y + 0.2), 0.06);
}

}  // namespace
}  // namespace roomgraph
