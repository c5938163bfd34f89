// SPDX-License-Identifier: BSD-3-Clause
// Way of a robot or hand-held camera through all rooms of a flat.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "flat_grid.h"
#include "sensor_path.h"

namespace roomgraph {
namespace {

constexpr double kMargin_m = 0.05;  ///< beyond the robot's radius: the driven curve rounds the planned corners
using Waypoints = std::vector<Eigen::Vector2d>;

/// Places of a room to go to: far from each other and with space around, then in the order of their direction from the
/// middle, beginning where the way comes in.
Waypoints placesToSee(const FloorGrid& grid, const Room& room, const Waypoints& reachable, const Eigen::Vector2d& from, int count) {
  const PlanBox area(room.min_m, room.max_m);
  Waypoints inside, chosen;
  for (const auto& cell : reachable)
    if (area.exteriorDistance(cell) < 1e-9 && grid.clearance(cell) > 0.3) inside.push_back(cell);
  if (inside.empty())
    for (const auto& cell : reachable)
      if (area.exteriorDistance(cell) < 1e-9) inside.push_back(cell);
  for (int i = 0; i < count && !inside.empty(); ++i) {
    double best = -1;
    Eigen::Vector2d farthest = inside.front();
    for (const auto& cell : inside) {
      double distance = i == 0 ? (cell - from).norm() : 1e9;
      for (const auto& other : chosen) distance = std::min(distance, (cell - other).norm());
      distance += 0.5 * std::min(1.0, grid.clearance(cell));
      if (distance > best) {
        best = distance;
        farthest = cell;
      }
    }
    if (i > 0 && best < 0.9) break;
    chosen.push_back(farthest);
  }
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& cell : inside) middle += cell / static_cast<double>(inside.size());
  const auto turned = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d d = p - middle, e = from - middle;
    return wrapAngle(std::atan2(d.y(), d.x()) - std::atan2(e.y(), e.x()) - std::numbers::pi) + std::numbers::pi;
  };
  std::sort(chosen.begin(), chosen.end(), [&](const auto& a, const auto& b) { return turned(a) < turned(b); });
  return chosen;
}

/// Moves every point towards the middle of its neighbours, as far as the clearance allows.
void smooth(Waypoints& way, const FloorGrid& grid, double clearance) {
  for (int pass = 0; pass < 60; ++pass)
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      const Eigen::Vector2d next = 0.5 * way[i] + 0.25 * (way[i - 1] + way[i + 1]);
      if (grid.clearance(next) >= std::min(clearance + 0.05, grid.clearance(way[i]))) way[i] = next;
    }
}

/// The ways from every goal to the next, and from the last to the first; empty when one cannot be reached.
std::vector<Waypoints> legsBetween(const Waypoints& goals, const FloorGrid& grid, double clearance) {
  std::vector<Waypoints> out;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    out.push_back(grid.way(goals[i], goals[(i + 1) % goals.size()], clearance));
    if (out.back().empty()) return {};
  }
  return out;
}

/// The first `count` legs, again from the first on after the last, smoothed, as points some decimetres apart.
Waypoints joined(const std::vector<Waypoints>& legs, std::size_t count, const FloorGrid& grid, double clearance) {
  Waypoints way{legs.front().front()}, out;
  for (std::size_t i = 0; i < count; ++i) {
    const Waypoints& leg = legs[i % legs.size()];
    way.insert(way.end(), leg.begin() + 1, leg.end());
  }
  smooth(way, grid, clearance);
  for (const auto& point : way)
    if (out.empty() || (point - out.back()).norm() >= 0.2) out.emplace_back(inSteps(point.x(), 0.001), inSteps(point.y(), 0.001));
  return out;
}

/// The rooms of which a fair part can be reached, in any order.
std::vector<std::size_t> roomOrder(const FlatDraft& draft, const Waypoints& reachable, Random& random) {
  constexpr double kCell_m2 = 0.05 * 0.05, kFairShare = 0.08;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < draft.world.rooms.size(); ++i) {
    const PlanBox area(draft.world.rooms[i].min_m, draft.world.rooms[i].max_m);
    const auto inside =
        std::count_if(reachable.begin(), reachable.end(), [&](const auto& cell) { return area.contains(cell); });
    if (static_cast<double>(inside) * kCell_m2 > kFairShare * area.volume()) out.push_back(i);
  }
  for (std::size_t i = out.size(); i > 1; --i)
    std::swap(out[i - 1], out[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(i) - 1))]);
  return out;
}

RobotPathSpec drawRobot(Random& random) {
  RobotPathSpec out;
  out.max_speed_m_s = inSteps(random.uniform(0.3, 0.6));
  out.max_turn_rad_s = inSteps(random.uniform(0.5, 1.0));
  out.acceleration_m_s2 = inSteps(random.uniform(0.25, 0.6));
  out.radius_m = inSteps(random.uniform(0.17, 0.2));
  return out;
}

/// Views along a way: ahead, and now and then at the middle of the room.
HandheldSpec handheldAlong(const Waypoints& way, const FlatDraft& draft, Random& random) {
  HandheldSpec out;
  out.speed_m_s = inSteps(random.uniform(0.3, 0.5));
  const double height = random.uniform(1.4, 1.6), phase = random.uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < way.size(); i += 3) {
    // Where the way turns back, the point ahead may be this one.
    const Eigen::Vector2d at = way[i], ahead = way[std::min(i + 6, way.size() - 1)];
    if ((ahead - at).norm() < 0.1) continue;
    Eigen::Vector2d look = ahead + (ahead - at).normalized();
    for (const auto& room : draft.world.rooms) {
      const Eigen::Vector2d middle = (room.min_m + room.max_m) / 2;
      if (!PlanBox(room.min_m, room.max_m).contains(at) || (middle - at).norm() < 1.2) continue;
      const double pull = 0.35 + 0.35 * std::sin(0.4 * static_cast<double>(i) + phase);
      look = (1 - pull) * look + pull * middle;
    }
    if ((look - at).norm() < 0.5) look = at + (ahead - at).normalized();
    const double z = height + 0.08 * std::sin(0.5 * static_cast<double>(i) + phase);
    out.keys.push_back({{at.x(), at.y(), inSteps(z)},
                        {inSteps(look.x(), 0.001), inSteps(look.y(), 0.001),
                         inSteps(height - random.uniform(0.15, 0.5) * (look - at).norm())}});
  }
  return out;
}

/// Seconds that the way takes; the draft then holds it.
double adopt(FlatDraft& draft, const Waypoints& way, const RobotPathSpec& robot, Random random) {
  if (draft.options.handheld) {
    draft.world.handheld = handheldAlong(way, draft, random);
    return draft.world.handheld->keys.size() < 2 ? 0 : SensorPath(*draft.world.handheld).duration();
  }
  draft.world.robot = robot;
  draft.world.robot->path_m = way;
  return SensorPath(*draft.world.robot).duration();
}

/// Does the curve that is driven keep clear of everything, of door leaves and people too?
bool keepsClear(const FlatDraft& draft, const FloorGrid& grid) {
  constexpr double kTolerance_m = 0.005;  // clearances are rounded down
  const SensorPath path = draft.world.robot ? SensorPath(*draft.world.robot) : SensorPath(*draft.world.handheld);
  const double radius = draft.world.robot ? draft.world.robot->radius_m : 0.1;
  for (double t = 0; t < path.duration(); t += 0.1)
    if (grid.clearance(path.at(t).translation().head<2>()) < radius - kTolerance_m) return false;
  return true;
}

/// Places to see in every room, room after room.
Waypoints goalsOf(const FlatDraft& draft, const FloorGrid& grid, const Waypoints& reachable, const std::vector<std::size_t>& order,
                  int places) {
  Waypoints out;
  for (const std::size_t i : order) {
    const Eigen::Vector2d from = out.empty() ? draft.world.rooms[i].min_m : out.back();
    for (const auto& place : placesToSee(grid, draft.world.rooms[i], reachable, from, draft.uses[i] == RoomUse::kCorridor ? 2 : places))
      out.push_back(place);
  }
  return out;
}

}  // namespace

bool planWay(FlatDraft& draft, Random& random) {
  constexpr double kShortest_s = 90, kLongest_s = 235;
  const RobotPathSpec robot = drawRobot(random);
  const double clearance = robot.radius_m + kMargin_m;
  const FloorGrid grid = floorGridOf(draft);
  const Room& first = draft.world.rooms[static_cast<std::size_t>(drawInt(random, 0, static_cast<int>(draft.world.rooms.size()) - 1))];
  Eigen::Vector2d start = first.min_m;
  for (double x = first.min_m.x() + 0.1; x < first.max_m.x(); x += 0.1)
    for (double y = first.min_m.y() + 0.1; y < first.max_m.y(); y += 0.1)
      if (grid.clearance({x, y}) > grid.clearance(start)) start = {x, y};
  const Waypoints reachable = grid.reachable(start, clearance);
  const auto order = roomOrder(draft, reachable, random);
  if (order.size() < draft.world.rooms.size()) return false;
  const Random tail = random;
  // Half of the rooms are seen again; more where that is short, none but the first place where it is too long.
  for (int places = draft.world.rooms.size() <= 2 ? 7 : 4; places >= 2; --places) {
    const Waypoints once = goalsOf(draft, grid, reachable, order, places);
    const auto legs = legsBetween(once, grid, clearance);
    if (legs.size() < 2) return false;
    const auto seconds_of = [&](double rounds) {
      const auto count = static_cast<std::size_t>(std::ceil(rounds * static_cast<double>(legs.size())));
      return adopt(draft, joined(legs, count, grid, clearance), robot, tail);
    };
    double seconds = seconds_of(1.5);
    if (seconds > kLongest_s) seconds = seconds_of(1);
    for (const double rounds : {2.5, 3.5})
      if (seconds < kShortest_s) seconds = seconds_of(rounds);
    if (seconds > 20 && seconds < kLongest_s && keepsClear(draft, grid) && isSound(draft.world)) return true;
  }
  return false;
}

}  // namespace roomgraph
