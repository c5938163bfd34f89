// SPDX-License-Identifier: BSD-3-Clause
// Wall frames, doorway holes and free areas; area and facing of the building's surfaces.
#include "floor_plan.h"

#include <gtest/gtest.h>

#include "example_world.h"
#include "roomgraph/core/random.h"

namespace roomgraph {
namespace {

/// Two rooms of 6 x 4 m and 3 x 4 m, a wall of 0.2 m between them with an open doorway of 1 x 2 m.
World twoRooms() {
  World world;
  world.wall_thickness_m = 0.2;
  world.wall_height_m = 2.5;
  const Material wall{"plaster", {1, 1, 1}, 1, 0}, floor{"carpet", {0, 0, 0}, 1, 0};
  Room left{"left", {0, 0}, {6, 4}, wall, floor, {}, {}, "rooms[0]"};
  Room right{"right", {6.2, 0}, {9.2, 4}, wall, floor, {}, {}, "rooms[1]"};
  left.doorways.push_back({Side::kEast, 1.5, 1, 2, DoorState::kNone, {}, "", "rooms[0].doorways[0]"});
  world.rooms = {left, right};
  return world;
}

double area(const Mesh& mesh, const MaterialList& materials, const std::string& pattern) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    if (materials.all()[static_cast<std::size_t>(t.material)].pattern == pattern)
      sum += (t.position[1] - t.position[0]).cross(t.position[2] - t.position[0]).norm() / 2;
  return sum;
}

TEST(FloorPlan, WallFramesLookIntoTheRoomFromItsInnerFaces) {
  const Room room = twoRooms().rooms[0];
  const struct {
    Side side;
    Eigen::Vector3d origin, inward;
  } expected[] = {{Side::kNorth, {1.5, 4, 0}, {0, -1, 0}},
                  {Side::kEast, {6, 1.5, 0}, {-1, 0, 0}},
                  {Side::kSouth, {1.5, 0, 0}, {0, 1, 0}},
                  {Side::kWest, {0, 1.5, 0}, {1, 0, 0}}};
  for (const auto& wall : expected) {
    const Pose3 frame = wallFrame(room, wall.side, 1.5);
    EXPECT_LT((frame.translation() - wall.origin).norm(), 1e-12);
    EXPECT_LT((frame.linear().col(0) - wall.inward).norm(), 1e-12);
    EXPECT_LT((frame.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  }
}

TEST(FloorPlan, ADoorwayIsAHoleThroughTheWallOnEverySide) {
  World world = twoRooms();
  Room& room = world.rooms[0];
  const auto hole = [&](Side side) {
    return doorwayHole(world, room, {side, 2, 1, 2, DoorState::kNone, {}, "", ""});
  };
  EXPECT_TRUE(hole(Side::kNorth).isApprox(PlanBox(Eigen::Vector2d(1.5, 4), Eigen::Vector2d(2.5, 4.2))));
  EXPECT_TRUE(hole(Side::kEast).isApprox(PlanBox(Eigen::Vector2d(6, 1.5), Eigen::Vector2d(6.2, 2.5))));
  EXPECT_TRUE(hole(Side::kSouth).isApprox(PlanBox(Eigen::Vector2d(1.5, -0.2), Eigen::Vector2d(2.5, 0))));
  EXPECT_TRUE(hole(Side::kWest).isApprox(PlanBox(Eigen::Vector2d(-0.2, 1.5), Eigen::Vector2d(0, 2.5))));
}

TEST(FloorPlan, ADiscIsFreeWhenAllOfItsPointsAre) {
  const auto areas = freeAreas(twoRooms());
  ASSERT_EQ(areas.size(), 3u);
  const auto free = [](const Eigen::Vector2d& p) {
    const bool left = p.x() >= 0 && p.x() <= 6, right = p.x() >= 6.2 && p.x() <= 9.2;
    return p.y() >= 0 && p.y() <= 4 && (left || right || (p.x() >= 6 && p.x() <= 6.2 && p.y() >= 1 && p.y() <= 2));
  };
  Random random(3);
  int yes = 0, no = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector2d center(random.uniform(-0.5, 9.5), random.uniform(-0.5, 4.5));
    const double radius = random.uniform(0, 0.45);
    // Sampled densely on a slightly larger and on a smaller circle: in between, 24 directions may miss a corner.
    const auto all = [&](double scale) {
      for (int k = 0; k < 720; ++k) {
        const double angle = k * 2 * 3.14159265358979 / 720;
        if (!free(center + scale * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)))) return false;
      }
      return free(center);
    };
    const bool found = discIsFree(areas, center, radius);
    if (all(1.03)) {
      EXPECT_TRUE(found) << center.transpose() << " " << radius;
      ++yes;
    }
    if (!all(0.85)) {
      EXPECT_FALSE(found) << center.transpose() << " " << radius;
      ++no;
    }
  }
  EXPECT_GT(yes, 1000);
  EXPECT_GT(no, 500);
}

TEST(FloorPlan, TheSurfacesHaveTheAreasOfThePlan) {
  MaterialList materials;
  const World world = twoRooms();
  const Mesh mesh = buildingMesh(world, materials);
  // Perimeters 20 m and 14 m; the hole of 1 x 2 m opens both faces of the wall between the rooms; its two
  // jambs and its lintel are 0.2 m deep.
  EXPECT_NEAR(area(mesh, materials, "plaster"), (20 + 14) * 2.5 - 2 * (1 * 2) + 0.2 * (2 + 2 + 1), 1e-4);
  EXPECT_NEAR(area(mesh, materials, "carpet"), 24 + 12 + 0.2, 1e-4);
  EXPECT_NEAR(area(mesh, materials, "tiles"), 24 + 12, 1e-4);
  EXPECT_EQ(area(mesh, materials, "poster"), 0);
}

TEST(FloorPlan, FloorsCeilingsAndWallsFaceTheirRoom) {
  MaterialList materials;
  World world = twoRooms();
  world.rooms.pop_back();
  world.rooms[0].doorways.clear();
  world.rooms[0].posters.push_back({Side::kWest, 2, 1.5, 0.8, 1.0, 7});
  const Mesh mesh = buildingMesh(world, materials);
  const Eigen::Vector3f middle(3, 2, 1.25f);
  for (const auto& t : mesh.triangles) {
    const auto& pattern = materials.all()[static_cast<std::size_t>(t.material)].pattern;
    if (pattern == "paint") continue;  // base boards stand out of their wall
    EXPECT_GT(t.normal[0].dot(middle - t.position[0]), 0) << pattern;
    if (pattern == "poster") {
      EXPECT_NEAR(t.position[0].x(), 0.02, 1e-6);
      EXPECT_NEAR(std::abs(t.position[0].y() - 2), 0.4, 1e-6);
      EXPECT_NEAR(std::abs(t.position[0].z() - 1.5), 0.5, 1e-6);
    }
  }
  EXPECT_NEAR(area(mesh, materials, "poster"), 0.8, 1e-6);
}

}  // namespace
}  // namespace roomgraph
