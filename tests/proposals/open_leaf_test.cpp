// SPDX-License-Identifier: BSD-3-Clause
// Doorways told by the open leaf, in rendered scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "door_generator.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

constexpr double kFace_m = 2.95;  // of the wall across the view, from the camera

BoxEvidence leafEvidence(const Scene& scene) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  return gatherEvidence(frame, test::detectionOf(1, labels, "door"), *database().find("door"),
                        groundInCamera(scene.world_from_camera));
}

// A wall across the view with a gap of .9 m from `from` towards +y, and a wall of the next room.
Scene wallWithGap(double from) {
  Scene scene = test::sceneAhead();
  scene.addBox(3.0, from - 1.5, 0, 3.0, 0.1, 0, 2.5, 2);
  scene.addBox(3.0, from + 0.9 + 1.5, 0, 3.0, 0.1, 0, 2.5, 2);
  scene.addBox(4.6, 0, 0, 6.0, 0.1, 0, 2.5, 3);
  return scene;
}

// Hinged at the wall's face, opened into the camera's room; `turned` against the wall, 0 when it is closed
// and towards +y. A box of the leaf alone.
void addLeaf(Scene& scene, double hinge_y, double turned) {
  const Eigen::Vector2d middle =
      Eigen::Vector2d(kFace_m, hinge_y) + 0.45 * Eigen::Vector2d(-std::sin(turned), std::cos(turned));
  scene.addBox(middle.x(), middle.y(), turned, 0.9, 0.03, 0.01, 2.05, 1);
}

void expectDoorway(const Scene& scene, double center_y) {
  const auto found = test::hypotheses<DoorGenerator>(leafEvidence(scene));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].source, "open leaf");
  const Eigen::Vector2d off(found[0].x - (kFace_m + 0.03), found[0].y - center_y);
  EXPECT_LT(off.norm(), 0.08);
  EXPECT_LT(std::abs(wrapAngle(found[0].yaw - std::numbers::pi)), 0.04) << "as the wall";
  EXPECT_LT(off.dot(found[0].covariance->topLeftCorner<2, 2>().inverse() * off), 9);
  EXPECT_GT(found[0].quality, 0.2);
}

// The camera stands where the leaf's face and the doorway are seen: the hinge is the leaf's far end.
TEST(OpenLeaf, TheDoorwayIsBesideItsFarEnd) {
  for (const double degrees : {85.0, 95.0, 110.0}) {
    SCOPED_TRACE(degrees);
    Scene scene = wallWithGap(-0.35);
    addLeaf(scene, 0.55, std::numbers::pi - degrees / 180 * std::numbers::pi);
    expectDoorway(scene, 0.1);
  }
}

// The leaf hides the doorway, and beside its free end the next room is seen.
TEST(OpenLeaf, TheDoorwayIsHiddenBehindIt) {
  for (const double degrees : {80.0, 95.0}) {
    SCOPED_TRACE(degrees);
    Scene scene = wallWithGap(0.5);
    addLeaf(scene, 0.5, degrees / 180 * std::numbers::pi);
    expectDoorway(scene, 0.95);
  }
}

// A screen that stands before the gap, its nearer and its farther end away from the wall, is not hinged
// there.
TEST(OpenLeaf, AHingeIsAtTheWall) {
  for (const double hinge_y : {-0.35, 0.5}) {
    Scene scene = wallWithGap(hinge_y);
    scene.addBox(kFace_m - 0.85, 0.53, std::numbers::pi / 2, 0.9, 0.03, 0.01, 2.05, 1);
    for (const auto& placed : test::hypotheses<DoorGenerator>(leafEvidence(scene)))
      EXPECT_NE(placed.source, "open leaf");
  }
}

// A door in the wall beside a corner, whose other wall seems to end at it.
TEST(OpenLeaf, AClosedDoorAtACornerIsNone) {
  for (const double ends : {0.5, 1.2}) {
    Scene scene = test::sceneAhead();
    scene.addBox(3.0, -1.0, 0, 3.2, 0.1, 0, 2.5, 2);
    scene.addBox((ends + 3) / 2, 0.65, std::numbers::pi / 2, 3 - ends, 0.1, 0, 2.5, 2);
    scene.addBox(2.5, 0.6, std::numbers::pi / 2, 0.8, 0.04, 0.01, 2.05, 1);
    const auto found = test::hypotheses<DoorGenerator>(leafEvidence(scene));
    ASSERT_FALSE(found.empty());
    EXPECT_NE(found[0].source, "open leaf") << ends;
    EXPECT_LT(std::hypot(found[0].x - 2.5, found[0].y - 0.62), 0.15);
  }
}

// A wall that goes on beside the hinge has no doorway there, be it seen or hidden by a cupboard: a board that
// leans out into the room.
TEST(OpenLeaf, NoDoorwayInAWholeWall) {
  for (const bool hidden : {false, true}) {
    Scene scene = test::sceneAhead();
    scene.addBox(3.0, 0, 0, 6.0, 0.1, 0, 2.5, 2);
    if (hidden) scene.addBox(2.8, -0.2, 0, 1.3, 0.3, 0, 2.2, 3);
    addLeaf(scene, 0.55, std::numbers::pi / 2);
    for (const auto& placed : test::hypotheses<DoorGenerator>(leafEvidence(scene)))
      EXPECT_NE(placed.source, "open leaf") << hidden;
  }
}

// Where the hinge is cannot be told, as the wall goes on beside it; but the leaf plainly stands open: its
// place says little about the door's.
TEST(OpenLeaf, SaysLittleWhereTheDoorIs) {
  const auto onLeaf = [](double turned) {
    Scene scene = test::sceneAhead();
    scene.addBox(3.0, 0, 0, 6.0, 0.1, 0, 2.5, 2);
    addLeaf(scene, -0.45 + 0.9 * std::sin(turned), turned);
    return test::hypotheses<DoorGenerator>(leafEvidence(scene));
  };
  const auto open = onLeaf(std::numbers::pi / 2), closed = onLeaf(0);
  ASSERT_EQ(open.size(), 1U);
  ASSERT_FALSE(closed.empty());
  EXPECT_LT(open[0].quality, 0.3);
  EXPECT_GT(closed[0].quality, 0.5);
  EXPECT_GT(std::sqrt(open[0].covariance->trace() / 2), 0.5);
}

// What a detector takes for a door, parallel to its wall and well before it, is a cupboard's front; in the
// wall's face it is a door.
TEST(OpenLeaf, ACupboardsFrontSaysLittle) {
  const auto before = [](double wall_m) {
    Scene scene = test::sceneAhead();
    scene.addBox(3.0, 0, 0, 6.0, 0.1, 0, 2.5, 2);
    scene.addBox(kFace_m - wall_m, 0, 0, 0.9, 0.03, 0.01, 2.05, 1);
    return test::hypotheses<DoorGenerator>(leafEvidence(scene));
  };
  const auto cupboard = before(0.4), door = before(0.02);
  ASSERT_FALSE(cupboard.empty());
  ASSERT_FALSE(door.empty());
  EXPECT_LT(cupboard[0].quality, 0.3);
  EXPECT_GT(door[0].quality, 0.5);
}

}  // namespace
}  // namespace roomgraph
