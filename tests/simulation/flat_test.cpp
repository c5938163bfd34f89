// SPDX-License-Identifier: BSD-3-Clause
// Random flats over many seeds: counts, sizes, overlaps, ways, sensors.
#include "roomgraph/simulation/flat.h"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "errors_of.h"
#include "floor_plan.h"
#include "person_model.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/geometry/shape.h"
#include "roomgraph/simulation/world_file.h"
#include "scene.h"
#include "sensor_path.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kFirst = 1, kLast = 20;

/// The flats of all seeds; every test looks at all of them.
const std::map<std::uint64_t, World>& flats() {
  static const std::map<std::uint64_t, World> all = [] {
    std::map<std::uint64_t, World> out;
    for (std::uint64_t seed = kFirst; seed <= kLast; ++seed) out.emplace(seed, randomFlat({seed, 0, seed % 6 == 0, ""}));
    return out;
  }();
  return all;
}

/// Plan of one piece, worked out from its entry: a rectangle, or 24 corners of an ellipse for round things.
std::vector<Eigen::Vector2d> outline(const Furniture& item) {
  static const std::set<std::string> round{"round_table", "stool", "plant", "bin", "coat_stand"};
  const Eigen::Vector2d half(item.size_m->y() / 2, item.size_m->x() / 2);
  const Eigen::Rotation2Dd turn(item.yaw_rad);
  std::vector<Eigen::Vector2d> out;
  const int corners = round.count(item.model) ? 24 : 4;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / corners;
    Eigen::Vector2d at(std::cos(angle), std::sin(angle));
    if (corners == 4) at *= std::numbers::sqrt2;
    out.push_back(turn * at.cwiseProduct(half) + item.at_m.head<2>());
  }
  return out;
}

bool isSeat(const std::string& model) {
  return model.find("chair") != std::string::npos || model == "stool";
}

TEST(Flat, HoldsWhatItShould) {
  std::set<std::size_t> rooms;
  std::set<std::string> models;
  std::set<std::size_t> people;
  for (const auto& [seed, world] : flats()) {
    int counted = 0, misleading = 0, bodies = 0;
    const Scene scene(world);
    for (const auto& object : scene.objects()) {
      const bool counts = object.class_name == "swivel_chair" || object.class_name == "sofa" || object.class_name == "door";
      counted += counts;
      bodies += object.class_name == "person";
      misleading += !counts && object.class_name != "person" && object.kind != "desk";
    }
    EXPECT_GE(counted, 8) << seed;
    EXPECT_LE(counted, 30) << seed;
    EXPECT_GE(misleading, counted) << seed;
    EXPECT_LE(bodies, 6) << seed;
    const bool corridor = world.rooms.front().name == "corridor";
    EXPECT_EQ(corridor, world.rooms.size() >= 3) << seed;
    rooms.insert(world.rooms.size() - corridor);
    people.insert(world.people.size());
    for (const auto& item : world.furniture) models.insert(item.model);
  }
  EXPECT_EQ(rooms, (std::set<std::size_t>{1, 2, 3, 4, 5}));
  EXPECT_GE(people.size(), 3u);
  for (const std::string model : {"printer", "monitor", "bin", "plant", "shelf", "stool", "wooden_chair", "visitor_chair", "armchair",
                                  "bench", "coat_stand", "box", "cabinet", "whiteboard", "round_table", "sofa"})
    EXPECT_TRUE(models.count(model)) << model;
}

TEST(Flat, NothingOverlaps) {
  for (const auto& [seed, world] : flats()) {
    for (std::size_t i = 0; i < world.furniture.size(); ++i) {
      const auto& a = world.furniture[i];
      const auto plan = outline(a);
      bool inside = false;
      for (const auto& room : world.rooms)
        inside = inside || std::all_of(plan.begin(), plan.end(), [&](const Eigen::Vector2d& corner) {
                   return PlanBox(room.min_m, room.max_m).exteriorDistance(corner) < 1e-3;
                 });
      EXPECT_TRUE(inside) << seed << ": " << a.place;
      for (std::size_t k = 0; k < i; ++k) {
        const auto& b = world.furniture[k];
        // One above the other: on a desk or a cabinet.
        if (a.at_m.z() >= b.at_m.z() + b.size_m->z() - 0.002 || b.at_m.z() >= a.at_m.z() + a.size_m->z() - 0.002) continue;
        const auto other = outline(b);
        const auto shared = intersectConvex(plan, other);
        const double area = shared.size() < 3 ? 0 : polygonArea(shared);
        // Seats stand partly under tables and desks, at most as far as their middle.
        const bool under = (isSeat(a.model) && b.model.find("table") != std::string::npos) || (isSeat(a.model) && b.model == "desk") ||
                           (isSeat(b.model) && a.model.find("table") != std::string::npos) || (isSeat(b.model) && a.model == "desk");
        const double allowed = under ? 0.55 * polygonArea(isSeat(a.model) ? plan : other) : 2e-4;
        EXPECT_LE(area, allowed) << seed << ": " << a.place << " (" << a.model << ") and " << b.place << " (" << b.model << ")";
      }
    }
  }
}

TEST(Flat, ThingsOnTopLieOnSomething) {
  int on_top = 0;
  for (const auto& [seed, world] : flats())
    for (const auto& item : world.furniture) {
      if (item.at_m.z() < 0.01 || item.model == "whiteboard") continue;
      ++on_top;
      EXPECT_TRUE(std::any_of(world.furniture.begin(), world.furniture.end(), [&](const Furniture& below) {
        const auto shared = intersectConvex(outline(item), outline(below));
        return std::abs(below.at_m.z() + below.size_m->z() - item.at_m.z()) < 0.002 && shared.size() > 2 &&
               polygonArea(shared) > 0.8 * item.size_m->x() * item.size_m->y();
      })) << seed << ": " << item.place << " " << item.model;
    }
  EXPECT_GT(on_top, 40);
}

/// Distance from a point to the leaf of an open door, whose hinge is on the left as seen from inside, m.
double distanceToLeaf(const Room& room, const Doorway& doorway, const Eigen::Vector2d& at) {
  const double angle = doorway.door == DoorState::kOpen ? 1.5 : 0.8;
  const Eigen::Vector3d local =
      wallFrame(room, doorway.side, doorway.at_m).inverse() * Eigen::Vector3d(at.x(), at.y(), 0);
  const Eigen::Vector2d hinge(0, doorway.width_m / 2 - 0.063), along(std::sin(angle), -std::cos(angle));
  const double s = std::clamp(along.dot(local.head<2>() - hinge), 0.0, doorway.width_m - 0.126);
  return (local.head<2>() - hinge - s * along).norm();
}

TEST(Flat, TheWayIsFreeAndLeadsThroughEveryRoom) {
  for (const auto& [seed, world] : flats()) {
    const SensorPath path = world.robot ? SensorPath(*world.robot) : SensorPath(*world.handheld);
    const double radius = world.robot ? world.robot->radius_m : 0.1;
    EXPECT_GT(path.duration(), 20) << seed;
    EXPECT_LT(path.duration(), 240) << seed;
    const auto areas = freeAreas(world);
    std::set<std::string> visited;
    for (double t = 0; t < path.duration(); t += 0.2) {
      const Eigen::Vector2d at = path.at(t).translation().head<2>();
      EXPECT_TRUE(discIsFree(areas, at, radius)) << seed << " at " << t << " s";
      for (const auto& room : world.rooms) {
        if (PlanBox(room.min_m, room.max_m).contains(at)) visited.insert(room.name);
        for (const auto& doorway : room.doorways) {
          if (doorwayHole(world, room, doorway).contains(at)) {
            EXPECT_NE(doorway.door, DoorState::kClosed) << seed;
          }
          if (doorway.door == DoorState::kOpen || doorway.door == DoorState::kHalfOpen) {
            EXPECT_GT(distanceToLeaf(room, doorway, at), radius) << seed << ": leaf of " << doorway.place << " at " << t << " s";
          }
        }
      }
    }
    EXPECT_EQ(visited.size(), world.rooms.size()) << seed;
  }
}

TEST(Flat, WalkersKeepAwayFromTheSensor) {
  int walkers = 0;
  for (const auto& [seed, world] : flats()) {
    const SensorPath path = world.robot ? SensorPath(*world.robot) : SensorPath(*world.handheld);
    for (const auto& person : world.people) {
      const PersonWalk walk(person);
      walkers += person.path_m.size() > 1;
      for (double t = 0; t < path.duration(); t += 0.25) {
        const Pose2 body = walk.at(t).pose;
        EXPECT_GT((path.at(t).translation().head<2>() - Eigen::Vector2d(body.x, body.y)).norm(), 0.3) << seed << " at " << t;
      }
    }
  }
  EXPECT_GE(walkers, 1);
}

TEST(Flat, SizesAreNotThoseOfTheObjectDatabase) {
  std::map<std::string, std::pair<Eigen::Vector3d, int>> sums;
  for (const auto& [seed, world] : flats()) {
    const Scene scene(world);
    for (const auto& object : scene.objects()) {
      auto& [sum, count] = sums.try_emplace(object.class_name, Eigen::Vector3d::Zero(), 0).first->second;
      sum += object.size_wdh;
      ++count;
    }
  }
  // Nominal sizes of objects.ini.
  const std::map<std::string, Eigen::Vector3d> nominal{
      {"swivel_chair", {0.62, 0.62, 0.95}}, {"sofa", {1.85, 0.88, 0.82}}, {"door", {0.9, 0.12, 2.05}}};
  for (const auto& [name, size] : nominal) {
    ASSERT_GT(sums[name].second, 20) << name;
    const Eigen::Vector3d mean = sums[name].first / sums[name].second;
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(std::abs(mean[axis] - size[axis]), 0.01) << name << " axis " << axis;
  }
}

TEST(Flat, SensorsAreThoseOfSmallRobots) {
  std::set<double> heights;
  for (const auto& [seed, world] : flats()) {
    ASSERT_TRUE(world.camera && world.detections && world.detections->persistent) << seed;
    EXPECT_EQ(world.lidar.has_value(), world.robot.has_value()) << seed;
    EXPECT_EQ(world.odometry.has_value(), world.robot.has_value()) << seed;
    if (!world.robot) continue;
    heights.insert(world.camera->at_m.z());
    EXPECT_TRUE(world.camera->at_m.z() >= 0.3 && world.camera->at_m.z() <= 1.3) << seed;
    EXPECT_TRUE(world.camera->pitch_down_rad >= 0 && world.camera->pitch_down_rad <= 25 * kDegree) << seed;
    EXPECT_TRUE(world.lidar->at_m.z() >= 0.1 && world.lidar->at_m.z() <= 0.4) << seed;
    EXPECT_TRUE(world.lidar->beams >= 360 && world.lidar->beams <= 720) << seed;
    EXPECT_TRUE(world.robot->max_speed_m_s >= 0.3 && world.robot->max_speed_m_s <= 0.6) << seed;
    EXPECT_LE(std::abs(world.odometry->scale_error), 0.05) << seed;
  }
  EXPECT_GT(heights.size(), 10u);
}

TEST(Flat, TheSeedDecidesEverything) {
  EXPECT_EQ(flatText({3, 0, false, ""}), flatText({3, 0, false, ""}));
  EXPECT_NE(flatText({3, 2, false, ""}), flatText({4, 2, false, ""}));
  // The text is what is simulated: writing and reading it again changes nothing.
  const std::string text = flatText({5, 0, false, ""});
  EXPECT_EQ(worldText(parseWorld(text, "a")), worldText(parseWorld(worldText(parseWorld(text, "a")), "b")));
}

TEST(Flat, RoomsAreAsManyAsAskedFor) {
  for (int rooms = 1; rooms <= 5; ++rooms)
    for (const std::uint64_t seed : {71, 72})
      EXPECT_EQ(randomFlat({seed, rooms, false, ""}).rooms.size(), static_cast<std::size_t>(rooms + (rooms >= 3))) << seed;
  EXPECT_THAT(test::messageOf<ConfigError>([] { flatText({1, 6, false, ""}); }), HasSubstr("1 to 5 rooms"));
}

}  // namespace
}  // namespace roomgraph
