// SPDX-License-Identifier: BSD-3-Clause
// Proposals of partly hidden, cut and rotated objects on rendered scenes.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "door_generator.h"
#include "proposal_covariance.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;
using test::sceneAhead;

BoxEvidence shadedEvidence(const Scene& scene, const std::string& class_name, bool with_depth = true) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  if (!with_depth) frame.depth = cv::Mat();
  return gatherEvidence(frame, test::detectionOf(1, labels, class_name), *database().find(class_name),
                        groundInCamera(scene.world_from_camera));
}

TEST(Occlusion, ChairBehindABoxIsNotPulledTowardsTheVisiblePart) {
  for (const double side : {1.0, -1.0}) {
    Scene scene = sceneAhead();
    scene.addCylinder(3.0, 0, 0.31, 0.95, 1);
    scene.addBox(1.8, side * 0.47, 0, 0.8, 0.3, 0, 1.3, 2);  // hides one side of the chair
    const BoxEvidence e = shadedEvidence(scene, "swivel_chair");
    EXPECT_EQ(e.hidden.left, side > 0);
    EXPECT_EQ(e.hidden.right, side < 0);
    EXPECT_FALSE(e.hidden.bottom);
    const auto found = test::hypotheses<CylinderGenerator>(e);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::hypot(found[0].x - 3.0, found[0].y), 0.15) << side;
  }
}

TEST(Occlusion, ChairWhoseFeetADeskHides) {
  Scene scene = sceneAhead();
  scene.addCylinder(2.8, 0.1, 0.31, 0.95, 1);
  scene.addBox(1.7, 0, 0, 2.0, 0.5, 0, 0.45, 2);
  const BoxEvidence e = shadedEvidence(scene, "swivel_chair");
  EXPECT_TRUE(e.hidden.bottom);
  EXPECT_FALSE(contactPoint(e));  // the box's bottom is not where it stands
  const auto found = test::hypotheses<CylinderGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(std::hypot(found[0].x - 2.8, found[0].y - 0.1), 0.15);
}

// Its table top reaches up to the chair, so that nothing is clearly nearer than the chair.
TEST(Occlusion, ChairPushedUnderATable) {
  constexpr double kRange_m = 2.4, kRadius_m = 0.31;
  Scene scene;
  scene.lookAhead(2.0, 0.6);
  scene.addCylinder(kRange_m, 0.1, kRadius_m, 0.95, 1);
  scene.addBox(kRange_m - kRadius_m - 0.86, 0, 0, 2.0, 1.6, 0.6, 0.65, 2);
  const BoxEvidence e = shadedEvidence(scene, "swivel_chair");
  EXPECT_TRUE(e.hidden.bottom);
  const auto found = test::hypotheses<CylinderGenerator>(e);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(std::hypot(found[0].x - kRange_m, found[0].y - 0.1), 0.1);
  EXPECT_NEAR(found[0].shape.height, 0.95, 0.05);
  EXPECT_GT(found[0].box_iou, 0.8) << "what the table hides is not missed";
  const auto whole = project(found[0], e);
  ASSERT_TRUE(whole);
  EXPECT_GT(whole->visible.v_max, e.box.v_max + 20) << "the shape goes on below the table top";
  EXPECT_EQ(visibleBounds(found[0], e).value().v_max, e.box.v_max);
}

// Over the table only a back rest shows, which is as flat from behind as from the front.
TEST(Occlusion, ABackRestHasItsSeatOnEitherSide) {
  constexpr double kBackRest_m = 2.4, kToMiddle_m = 0.28;
  Scene scene;
  scene.lookAhead(1.4, 0.3);
  scene.addBox(kBackRest_m, 0.1, 0, 0.5, 0.06, 0.45, 0.95, 1);
  scene.addBox(kBackRest_m - 0.9, 0, 0, 2.4, 1.6, 0.6, 0.65, 2);
  const BoxEvidence e = shadedEvidence(scene, "swivel_chair");
  ASSERT_TRUE(e.hidden.bottom);
  const auto found = test::hypotheses<CylinderGenerator>(e);
  for (const double middle : {kBackRest_m - kToMiddle_m, kBackRest_m + kToMiddle_m}) {
    const auto right = std::find_if(found.begin(), found.end(), [middle](const PlacedShape& placed) {
      return std::hypot(placed.x - middle, placed.y - 0.1) < 0.12;
    });
    ASSERT_NE(right, found.end()) << middle;
    const Eigen::Matrix4d covariance = covarianceOf(*right, e, 0);
    EXPECT_GT(std::sqrt(covariance(0, 0)), 0.3) << "it may be the other one";
    EXPECT_LT(std::sqrt(covariance(1, 1)), 0.1) << "across the view it is known";
  }
  scene.solids.pop_back();  // without the table the floor shows that nothing is hidden
  for (const PlacedShape& placed : test::hypotheses<CylinderGenerator>(shadedEvidence(scene, "swivel_chair")))
    EXPECT_EQ(placed.open_along_m, 0);
}

// A monitor that a detector takes for a chair: its lower end is where it stands.
TEST(Occlusion, WhatStandsOnATableIsNotBehindIt) {
  Scene scene;
  scene.lookAhead(1.4, 0.35);
  scene.addBox(1.9, 0, 0, 2.0, 1.6, 0.6, 0.65, 2);
  scene.addBox(2.2, 0.1, 0, 0.5, 0.1, 0.65, 1.05, 1);
  EXPECT_FALSE(shadedEvidence(scene, "swivel_chair").hidden.bottom);
}

TEST(Occlusion, WhatStandsFartherAwayHidesNoBottom) {
  Scene scene = sceneAhead();
  scene.addBox(3.0, 0, 0, 2.0, 0.8, 0, 0.6, 2);
  scene.addCylinder(2.7, 0.1, 0.31, 0.95, 1);
  BoxEvidence e = shadedEvidence(scene, "swivel_chair");
  EXPECT_FALSE(e.hidden.bottom) << "floor is below it";
}

TEST(Occlusion, NothingIsHiddenInTheOpen) {
  Scene scene = sceneAhead();
  scene.addCylinder(2.5, 0.1, 0.31, 0.95, 1);
  scene.addBox(3.6, 0, 0, 5, 0.2, 0, 2, 2);  // a wall behind
  const BoxEvidence e = shadedEvidence(scene, "swivel_chair");
  EXPECT_FALSE(e.hidden.left || e.hidden.right || e.hidden.top || e.hidden.bottom);
}

TEST(Occlusion, SofaCutByTheBorderOnEitherSide) {
  for (const double y : {1.25, -1.25}) {
    Scene scene = sceneAhead();
    const double front = std::numbers::pi + std::atan2(y, 2.3) + 0.3;
    scene.addSofa(2.3, y, front, 1.8, 0.88, 0.8, 1);
    const BoxEvidence e = shadedEvidence(scene, "sofa");
    ASSERT_TRUE(y > 0 ? e.cut.left : e.cut.right);
    const auto found = test::hypotheses<CuboidGenerator>(e);
    ASSERT_FALSE(found.empty());
    double best = 1e9;
    for (const auto& p : found) best = std::min(best, std::hypot(p.x - 2.3, p.y - y));
    EXPECT_LT(best, 0.3) << y;
  }
}

TEST(Door, WithoutDepthTheFrameGivesTheDirection) {
  for (const double turn : {0.0, 0.5, -0.5}) {
    Scene scene;
    scene.lookAhead(1.2, 0.1);
    scene.max_range = 8;
    const double yaw = std::numbers::pi + turn;
    scene.addBox(3.4, 0.2, yaw, 0.9, 0.06, 0, 2.05, 1);
    const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door", false));
    ASSERT_FALSE(found.empty()) << turn;
    EXPECT_LT(std::hypot(found[0].x - 3.4, found[0].y - 0.2), 0.1) << turn;
    EXPECT_LT(std::abs(wrapAngle(2 * (found[0].yaw - yaw)) / 2), 0.1) << turn;
  }
}

// Wall with a gap and posts in it; the leaf stands nearly at a right angle to it, hinged at the left post.
// The door is where it is when it is closed.
TEST(Door, OpenLeafInItsFrame) {
  Scene scene = sceneAhead();
  scene.addBox(3.0, 1.6, 0, 2.0, 0.1, 0, 2.5, 2);
  scene.addBox(3.0, -1.4, 0, 2.0, 0.1, 0, 2.5, 3);
  for (const double post : {0.57, -0.37}) scene.addBox(3.0, post, 0, 0.06, 0.12, 0, 2.05, 1);
  scene.addBox(2.6, 0.5, std::numbers::pi / 2 - 0.35, 0.9, 0.05, 0, 2.05, 1);
  const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door"));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].source, "wall");
  EXPECT_LT(std::hypot(found[0].x - 3.0, found[0].y - 0.1), 0.15);
  EXPECT_LT(std::abs(std::sin(found[0].yaw)), 0.03) << "as the wall";
}

// A leaf alone may be open; one flush with a wall, seen on one side, is closed; one turned against that wall
// is not.
TEST(Door, WhereALeafMayBeOpenTheDoorMayBeBesideIt) {
  const auto sigmas = [](bool wall, double turned) {
    Scene scene = sceneAhead();
    scene.addBox(3.0, 0, turned, 0.9, 0.06, 0, 2.05, 1);
    if (wall) scene.addBox(3.02, 1.0, 0, 1.0, 0.1, 0, 2.5, 2);
    const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door"));
    EXPECT_EQ(found.at(0).source, "depth plane");
    const Eigen::Matrix3d& covariance = found.at(0).covariance.value();
    return std::pair(std::sqrt(covariance(0, 0)), std::sqrt(covariance(2, 2)));
  };
  for (const auto& [wall, turned] : {std::pair(false, 0.0), {false, 0.5}, {true, 0.5}}) {
    const auto [place, yaw] = sigmas(wall, turned);
    EXPECT_NEAR(place, 0.25, 0.1);
    EXPECT_NEAR(yaw, 0.6, 0.1);
  }
  const auto [place, yaw] = sigmas(true, 0);
  EXPECT_LT(place, 0.05);
  EXPECT_LT(yaw, 0.1);
}

// The front of a cupboard, .4 m before the wall it stands at, is not in that wall.
TEST(Door, TheFrontOfACupboardIsNotInTheWallBehindIt) {
  Scene scene = sceneAhead();
  scene.addBox(3.0, 0, 0, 6.0, 0.1, 0, 2.5, 2);
  scene.addBox(2.75, 0, 0, 0.9, 0.4, 0, 2.0, 1);
  const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door"));
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].source, "depth plane");
  EXPECT_NEAR(found[0].x, 2.55, 0.06);
}

// At the end of a corridor most of what is seen beside the door are the walls along it.
TEST(Door, WallsThatComeTowardsTheCameraAreNotTheDoors) {
  Scene scene = sceneAhead();
  scene.addBox(3.0, 0, 0, 1.3, 0.1, 0, 2.5, 2);
  for (const double side : {-0.7, 0.7}) scene.addBox(1.5, side, 0, 0.1, 3.0, 0, 2.5, 3);
  scene.addBox(2.96, 0, 0, 0.9, 0.06, 0, 2.05, 1);
  const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door"));
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].x, 2.95, 0.06);
  EXPECT_LT(std::abs(std::sin(found[0].yaw)), 0.03);
}

// A leaf set back from the wall's face by the wall's thickness: the box shows the frame's edges on the face.
TEST(Door, WidthIsMeasuredOnTheFaceOfTheWall) {
  for (const double y : {0.0, 0.8}) {
    Scene scene = sceneAhead();
    for (const double side : {-1.0, 1.0}) {
      scene.addBox(3.0, y + side * 1.4, 0, 2.0, 0.16, 0, 2.5, 2);  // leaves a gap of .8 m
      scene.addBox(3.0, y + side * 0.37, 0, 0.06, 0.16, 0, 2.05, 1);
    }
    scene.addBox(3.06, y, 0, 0.7, 0.04, 0, 2.05, 1);
    const auto found = test::hypotheses<DoorGenerator>(shadedEvidence(scene, "door"));
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].source, "wall");
    EXPECT_NEAR(found[0].x, 2.92 + 0.03, 0.02) << "half of the usual depth behind the face";
    EXPECT_NEAR(found[0].y, y, 0.03);
    const double usual = 0.9, sigma = 0.1, prior = 1 / (sigma * sigma), seen = found[0].size_information[0];
    EXPECT_NEAR(((seen + prior) * found[0].shape.width - prior * usual) / seen, 0.8, 0.03) << y;
  }
}

TEST(Symmetry, OfAQuarterTurn) {
  const ObjectDatabase tables = ObjectDatabase::fromText(
      "[table]\nlabels = table\nwidth_m = 0.8\ndepth_m = 0.8\nheight_m = 0.5\nsymmetry = 4\n");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> range(1.8, 2.8), turn(0, std::numbers::pi / 2);
  for (int run = 0; run < 6; ++run) {
    Scene scene = sceneAhead();
    const double x = range(random), yaw = turn(random);
    scene.addBox(x, 0, yaw, 0.8, 0.8, 0, 0.5, 1);
    cv::Mat labels;
    const Frame frame = scene.render(&labels);
    const BoxEvidence e = gatherEvidence(frame, test::detectionOf(1, labels, "table"), *tables.find("table"),
                                         groundInCamera(scene.world_from_camera));
    const auto found = test::hypotheses<CuboidGenerator>(e);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::hypot(found[0].x - x, found[0].y), 0.1) << run;
    EXPECT_LT(std::abs(wrapAngle(4 * (found[0].yaw - yaw))) / 4, 0.12) << run;
  }
}

}  // namespace
}  // namespace roomgraph
