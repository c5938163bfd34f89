// SPDX-License-Identifier: BSD-3-Clause
// Doorways through which the next room is seen, in rendered scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "door_generator.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

constexpr double kFace_m = 2.95;                   // of the wall across the view, from the camera
constexpr double kWidth_m = 0.9, kFrame_m = 0.06;  // of the door, and of the posts of its frame
constexpr double kNearer_m = 1.9;                  // what stands before the wall beside the door

BoxEvidence evidenceOf(const Scene& scene) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  return gatherEvidence(frame, test::detectionOf(1, labels, "door"), *database().find("door"),
                        groundInCamera(scene.world_from_camera));
}

std::vector<PlacedShape> found(const Scene& scene) {
  return test::hypotheses<DoorGenerator>(evidenceOf(scene));
}

// The next room's wall, parallel to the door's.
void addNextRoom(Scene& scene, double distance_m = 4.6) {
  scene.addBox(distance_m, 0, 0, 8.0, 0.1, 0, 2.5, 3);
}

// A wall across the view with a doorway in its middle, of which the frame belongs to the door.
Scene doorway() {
  Scene scene = test::sceneAhead();
  for (const double side : {-1.0, 1.0}) {
    scene.addBox(3.0, side * (kWidth_m / 2 + 1.5), 0, 3.0, 0.1, 0, 2.5, 2);
    scene.addBox(3.0, side * (kWidth_m - kFrame_m) / 2, 0, kFrame_m, 0.1, 0, 2.05, 1);
  }
  scene.addBox(3.0, 0, 0, kWidth_m, 0.1, 2.05 - kFrame_m, 2.05, 1);
  addNextRoom(scene);
  return scene;
}

void expectInWall(const PlacedShape& door) {
  const Eigen::Vector2d off(door.x - (kFace_m + 0.03), door.y);
  EXPECT_LT(off.norm(), 0.08);
  EXPECT_LT(std::abs(std::sin(door.yaw)), 0.04);
  EXPECT_LT(off.dot(door.covariance->topLeftCorner<2, 2>().inverse() * off), 9);
  EXPECT_GT(door.quality, 0.3);
}

TEST(Doorway, IsInTheWallBesideItNotInTheOneSeenThroughIt) {
  const auto shapes = found(doorway());
  ASSERT_FALSE(shapes.empty());
  EXPECT_EQ(shapes[0].source, "wall");
  expectInWall(shapes[0]);
}

// Cupboards on both sides of a closed door: its wall goes on above it.
TEST(Doorway, CupboardsBesideAClosedDoorAreNotItsWall) {
  Scene scene = test::sceneAhead();
  scene.addBox(3.6, 0, 0, 8.0, 0.1, 0, 2.9, 2);
  scene.addBox(3.54, 0, 0, kWidth_m, 0.03, 0.01, 2.05, 1);
  for (const double side : {-1.0, 1.0}) scene.addBox(3.3, side * 1.2, 0, 1.4, 0.5, 0, 1.9, 3);
  const auto shapes = found(scene);
  ASSERT_FALSE(shapes.empty());
  EXPECT_NEAR(shapes[0].x, 3.54, 0.08);
}

// On the other side a shelf hides the wall.
TEST(Doorway, OneSideOfTheWallIsEnough) {
  for (const double side : {-1.0, 1.0}) {
    Scene scene = doorway();
    scene.addBox(kNearer_m + 0.3, side * 1.1, 0, 1.2, 0.3, 0, 2.4, 4);
    const auto shapes = found(scene);
    ASSERT_FALSE(shapes.empty());
    EXPECT_EQ(shapes[0].source, "one side of the wall");
    expectInWall(shapes[0]);
  }
}

// A wall that ends before the door is not its wall: the frame is not on it.
TEST(Doorway, AWallThatEndsBeforeTheDoorIsNotItsWall) {
  for (const double side : {-1.0, 1.0}) {
    Scene scene = doorway();
    scene.addBox(kNearer_m, side * (0.3 + 1.5), 0, 3.0, 0.1, 0, 2.5, 4);
    for (const auto& shape : found(scene)) EXPECT_GT(shape.x, kFace_m - 0.2);
  }
}

}  // namespace
}  // namespace roomgraph
