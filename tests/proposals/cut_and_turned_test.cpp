// SPDX-License-Identifier: BSD-3-Clause
// Directions of vertical faces, and what the sides of a box say of an object that goes on beyond them.
#include <gtest/gtest.h>

#include <numbers>

#include "cuboid_generator.h"
#include "roomgraph/proposals/shape_fit.h"
#include "scene.h"
#include "vertical_faces.h"

namespace roomgraph {
namespace {

using test::Scene;
using test::sceneAhead;

const ObjectDatabase& furniture() {
  static const ObjectDatabase database = ObjectDatabase::fromText(
      "[couch]\nlabels = couch\nwidth_m = 1.8\ndepth_m = 0.88\nheight_m = 0.82\nwidth_sigma_m = 0.3\ndepth_sigma_m = 0.1\n"
      "height_sigma_m = 0.1\nfront = high_back\nsolid_share = 0.4\n"
      "[table]\nlabels = table\nwidth_m = 1.4\ndepth_m = 0.8\nheight_m = 0.74\nwidth_sigma_m = 0.3\nsymmetry = 2\n"
      "[bed]\nlabels = bed\nwidth_m = 1.6\ndepth_m = 2\nheight_m = 0.5\nwidth_sigma_m = 0.1\ndepth_sigma_m = 0.1\n");
  return database;
}

BoxEvidence evidenceOf(const Scene& scene, const std::string& class_name) {
  cv::Mat labels;
  const Frame frame = scene.render(&labels);
  return gatherEvidence(frame, test::detectionOf(1, labels, class_name), *furniture().find(class_name),
                        groundInCamera(scene.world_from_camera));
}

TEST(VerticalFaces, HaveTheDirectionsOfASofa) {
  for (const double yaw : {2.4, 2.9, 3.1, -2.7}) {
    Scene scene = sceneAhead();
    scene.addSofa(2.6, 0.1, yaw, 1.8, 0.88, 0.82, 1);
    const BoxEvidence e = evidenceOf(scene, "couch");
    EXPECT_GT(e.faces.azimuths.size(), 50u);
    for (const double azimuth : {yaw, yaw + std::numbers::pi / 2}) EXPECT_GT(faceAgreement(e.faces, azimuth), 0.9) << yaw;
    for (const double off : {-0.6, 0.4, std::numbers::pi / 4}) EXPECT_LT(faceAgreement(e.faces, yaw + off), 0.4) << yaw;
    const auto found = test::hypotheses<CuboidGenerator>(e);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::abs(wrapAngle(found[0].yaw - yaw)), 0.08);
  }
}

TEST(VerticalFaces, WhatIsLevelHasNone) {
  Scene scene;
  scene.lookAhead(1.4, 0.5);
  scene.addBox(2.2, 0, 0.4, 1.4, 0.8, 0.70, 0.74, 1);
  const BoxEvidence e = evidenceOf(scene, "table");
  ASSERT_GT(e.mask.points.size(), 100u);
  EXPECT_LT(e.faces.azimuths.size(), e.mask.points.size() / 20);
  EXPECT_EQ(faceAgreement({}, 1), 1) << "without faces every direction is as good";
}

// The left part of a long sofa is outside the image: its length is not measured, however much of it is seen.
TEST(Cut, TheLengthOfWhatGoesOnIsNotMeasured) {
  Scene scene = sceneAhead();
  scene.addSofa(2.2, 0.9, std::numbers::pi, 2.4, 0.88, 0.82, 1);
  const BoxEvidence e = evidenceOf(scene, "couch");
  ASSERT_TRUE(e.cut.left);
  const auto found = test::hypotheses<CuboidGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].size_information[0], 0);
  EXPECT_GE(found[0].shape.width, 1.75) << "it is no shorter than usual because a part is seen";

  Scene whole = sceneAhead();
  whole.addSofa(3.2, 0.1, std::numbers::pi, 2.2, 0.88, 0.82, 1);
  const auto measured = test::hypotheses<CuboidGenerator>(evidenceOf(whole, "couch"));
  ASSERT_FALSE(measured.empty());
  EXPECT_GT(measured[0].size_information[0], 20);
  EXPECT_NEAR(measured[0].shape.width, 2.2, 0.1);
}

// The nearest corner is outside the image, to the left: what is in view of it does not reach as low.
TEST(Cut, TheBoxIsThatOfThePartInView) {
  Scene scene = sceneAhead();
  const double yaw = -std::numbers::pi / 2;  // along the left wall
  scene.addSofa(2.2, 1.5, yaw, 2.4, 0.88, 0.82, 1);
  const BoxEvidence e = evidenceOf(scene, "couch");
  ASSERT_TRUE(e.cut.left && !e.cut.bottom);
  PlacedShape truth = usualShape(e);
  truth.x = 2.2, truth.y = 1.5, truth.yaw = yaw, truth.has_yaw = true;
  truth.shape.width = 2.4;
  judge(truth, e);
  EXPECT_GT(truth.box_iou, 0.9);
  const auto projected = project(truth, e);
  ASSERT_TRUE(projected);
  EXPECT_LT(iou(clipped(projected->full, e.camera.width, e.camera.height), e.box), truth.box_iou - 0.1);
  const auto found = test::hypotheses<CuboidGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].y, truth.y, 0.1);
  EXPECT_NEAR(found[0].x + found[0].shape.width / 2, truth.x + truth.shape.width / 2, 0.12) << "its far end is seen";
  EXPECT_LT(std::abs(wrapAngle(found[0].yaw - yaw)), 0.1);
}

// The leg of a table that is outside the image may be the one that reaches lowest.
TEST(Cut, ATableBeyondTheImageHasNoBottomSide) {
  for (const double y : {0.9, 0.0}) {
    Scene scene = sceneAhead();
    scene.addBox(2.0, y, 0, 1.4, 0.8, 0.66, 0.74, 1);
    for (const double leg : {-0.65, 0.65})
      for (const double side : {-0.35, 0.35}) scene.addBox(2.0 + side, y + leg, 0, 0.06, 0.06, 0, 0.7, 1);
    const BoxEvidence e = evidenceOf(scene, "table");
    EXPECT_EQ(e.cut.bottom, e.cut.left || e.cut.right) << y;
  }
}

// Beams pass below a bed as they do below a table, but its side is seen.
TEST(Cut, ABedBeyondTheImageHasItsBottomSide) {
  Scene scene = sceneAhead();
  scene.addBox(3.0, 1.6, std::numbers::pi, 1.55, 2.05, 0.05, 0.5, 1);
  const BoxEvidence e = evidenceOf(scene, "bed");
  ASSERT_TRUE(e.cut.left || e.cut.right);
  ASSERT_EQ(e.model->solid_share, 0);
  EXPECT_FALSE(e.cut.bottom);
  const auto found = test::hypotheses<CuboidGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].x, 3.0, 0.3);
}

}  // namespace
}  // namespace roomgraph
