// SPDX-License-Identifier: BSD-3-Clause
// Floor grid and polygons of the generator of flats against closed forms.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "flat_grid.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {
namespace {

Furniture blockAt(double x, double y, double yaw, double w, double d) {
  Furniture out;
  out.model = "block";
  out.at_m = {x, y, 0};
  out.yaw_rad = yaw;
  out.size_m = Eigen::Vector3d(w, d, 1);
  return out;
}

TEST(FlatParts, PolygonsTouchWhereTheirIntersectionHasAnArea) {
  Random random(5);
  int touching = 0;
  for (int i = 0; i < 500; ++i) {
    const auto draw = [&] {
      return floorPolygon(blockAt(random.uniform(0, 2), random.uniform(0, 2), random.uniform(-3, 3), random.uniform(0.2, 1), random.uniform(0.2, 1)));
    };
    const Polygon a = draw(), b = draw();
    const auto shared = intersectConvex(a, b);
    const double area = shared.size() < 3 ? 0 : polygonArea(shared);
    if (std::abs(area) > 1e-9 || shared.empty()) {
      EXPECT_EQ(touch(a, b), area > 1e-9);
    }
    touching += touch(a, b);
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, 450);
}

TEST(FlatParts, ClearanceIsTheDistanceToTheNearestObstacle) {
  const PlanBox room(Eigen::Vector2d(0, 0), Eigen::Vector2d(4, 3));
  const FloorGrid grid({room}, {boxPolygon(PlanBox(Eigen::Vector2d(2, 0), Eigen::Vector2d(2.4, 2)))}, 0.05);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d at(random.uniform(0, 4), random.uniform(0, 3));
    const double walls = std::min({at.x(), at.y(), 4 - at.x(), 3 - at.y()});
    const double box = std::hypot(std::max({2 - at.x(), 0.0, at.x() - 2.4}), std::max(0.0, at.y() - 2));
    EXPECT_NEAR(grid.clearance(at), std::min(walls, box), 0.08);
  }
  EXPECT_EQ(grid.clearance({-1, 1}), 0);
}

TEST(FlatParts, WaysGoAroundAndKeepTheirClearance) {
  const PlanBox room(Eigen::Vector2d(0, 0), Eigen::Vector2d(4, 3));
  const FloorGrid grid({room}, {boxPolygon(PlanBox(Eigen::Vector2d(2, 0), Eigen::Vector2d(2.4, 2)))}, 0.05);
  const auto way = grid.way({1, 0.5}, {3.5, 0.5}, 0.3);
  ASSERT_GT(way.size(), 10u);
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_LT((way[i] - way[i - 1]).norm(), 0.15);
    length += (way[i] - way[i - 1]).norm();
    EXPECT_GE(grid.clearance(way[i]), 0.3 - 1e-6);
  }
  // Around the upper corners at 0.3 m: two tangents and an arc each; steps of 45 degrees are up to 8.3 % longer.
  EXPECT_GT(length, 4.3);
  EXPECT_LT(length, 6.5);
  EXPECT_TRUE(grid.way({1, 0.5}, {3.5, 0.5}, 0.55).empty()) << "only 1 m is left above the box";
  // Left of the box, right of it, above it, and what the quarter circles around its corners leave.
  const double reached = static_cast<double>(grid.reachable({1, 1}, 0.3).size()) * 0.05 * 0.05;
  EXPECT_NEAR(reached, 1.4 * 2.4 + 1.0 * 2.4 + 1.0 * 0.4 + 2 * 0.09 * (1 - std::numbers::pi / 4), 0.2);
  EXPECT_TRUE(grid.reachable({2.2, 1}, 0.3).empty());
}

// An obstacle turned by any angle: the distance in its own frame.
TEST(FlatParts, ClearanceOfATurnedObstacle) {
  const PlanBox room(Eigen::Vector2d(0, 0), Eigen::Vector2d(5, 5));
  const Eigen::Vector2d half(0.7, 0.25), middle(2.5, 2.5);
  Random random(4);
  for (const double yaw : {0.3, 0.785, 1.2, 2.9}) {
    const Eigen::Rotation2Dd turn(yaw);
    Polygon obstacle;
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      obstacle.emplace_back(middle + turn * Eigen::Vector2d(x * half.x(), y * half.y()));
    const FloorGrid grid({room}, {obstacle}, 0.05);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d at(random.uniform(0, 5), random.uniform(0, 5));
      const Eigen::Vector2d inside = turn.inverse() * (at - middle);
      const double off = (inside.cwiseAbs() - half).cwiseMax(0).norm();
      const double walls = std::min({at.x(), at.y(), 5 - at.x(), 5 - at.y()});
      EXPECT_NEAR(grid.clearance(at), std::min(walls, off), 0.09) << "yaw " << yaw;
    }
  }
}

// Two rooms, and a gap of .8 m between them: a robot of .3 m radius comes through, one of .5 m does not.
TEST(FlatParts, AGapIsReachedThroughByWhatIsNarrower) {
  const PlanBox left(Eigen::Vector2d(0, 0), Eigen::Vector2d(3, 3)), right(Eigen::Vector2d(3.2, 0), Eigen::Vector2d(6, 3));
  const PlanBox gap(Eigen::Vector2d(2.9, 1), Eigen::Vector2d(3.3, 1.8));
  const FloorGrid grid({left, right, gap}, {}, 0.05);
  const auto beyond = [](const std::vector<Eigen::Vector2d>& cells) {
    return std::count_if(cells.begin(), cells.end(), [](const Eigen::Vector2d& at) { return at.x() > 3.2; });
  };
  const double cell_m2 = 0.05 * 0.05;
  EXPECT_NEAR(static_cast<double>(beyond(grid.reachable({1.5, 1.4}, 0.3))) * cell_m2, 2.2 * 2.4, 0.35);
  EXPECT_EQ(beyond(grid.reachable({1.5, 1.4}, 0.5)), 0);
  EXPECT_NEAR(static_cast<double>(grid.reachable({1.5, 1.4}, 0.5).size()) * cell_m2, 2.0 * 2.0, 0.25);
  EXPECT_TRUE(grid.way({1.5, 1.4}, {5, 1.4}, 0.5).empty());
  EXPECT_FALSE(grid.way({1.5, 1.4}, {5, 1.4}, 0.3).empty());
}

TEST(FlatParts, NoWayLeadsThroughAClosedDoor) {
  FlatDraft draft;
  Room room;
  room.min_m = {0, 0};
  room.max_m = {3, 3};
  Doorway doorway;
  doorway.side = Side::kEast;
  doorway.at_m = 1.5;
  doorway.width_m = 1;
  room.doorways = {doorway};
  draft.world.rooms = {room};
  room.doorways.clear();
  room.min_m.x() = 3 + draft.world.wall_thickness_m;
  room.max_m.x() = 6;
  draft.world.rooms.push_back(room);
  const auto ways = [&](DoorState door) {
    draft.world.rooms[0].doorways[0].door = door;
    return !floorGridOf(draft).way({1.5, 1.5}, {4.5, 1.5}, 0.25).empty();
  };
  EXPECT_TRUE(ways(DoorState::kNone));
  EXPECT_TRUE(ways(DoorState::kOpen));
  EXPECT_FALSE(ways(DoorState::kClosed));
}

TEST(FlatParts, LeavesOfOpenDoorsStandInTheRoom) {
  Room room;
  room.min_m = {0, 0};
  room.max_m = {4, 4};
  Doorway doorway;
  doorway.side = Side::kNorth;
  doorway.at_m = 2;
  doorway.width_m = 1;
  EXPECT_FALSE(leafPolygon(room, doorway));
  doorway.door = DoorState::kOpen;
  // From inside, looking at the north wall from the south, the left post is the western one seen from the wall: x = 2.437.
  PlanBox box;
  const auto leaf = leafPolygon(room, doorway);
  ASSERT_TRUE(leaf);
  for (const auto& corner : *leaf) box.extend(corner);
  EXPECT_NEAR(box.max().y(), 4, 0.12);
  EXPECT_NEAR(box.min().y(), 4 - 0.874, 0.05);
  EXPECT_LT(box.sizes().x(), 0.3);
  EXPECT_NEAR(polygonArea(*leaf), 0.14 * 0.874, 1e-9);
}

TEST(FlatParts, DrawsAreUniformOrSkewed) {
  Random random(9);
  std::map<int, int> counts;
  double sum = 0;
  for (int i = 0; i < 6000; ++i) {
    ++counts[drawInt(random, 2, 4)];
    sum += drawSkewed(random, 1, 2, 2);
  }
  ASSERT_EQ(counts.size(), 3u);
  for (const auto& [value, count] : counts) EXPECT_NEAR(count, 2000, 150) << value;
  EXPECT_NEAR(sum / 6000, 1 + 1.0 / 3, 0.02);  // mean of u^2
}

}  // namespace
}  // namespace roomgraph
