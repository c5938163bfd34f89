// SPDX-License-Identifier: BSD-3-Clause
// Parser of world files: rooms, doorways, furniture, people, robot and hand-held paths.
#include "roomgraph/simulation/world_file.h"

#include "json_entry.h"
#include "models.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/geometry/degree.h"
#include "sensor_entries.h"
#include "texture.h"
#include "world_check.h"
#include "world_names.h"

namespace roomgraph {
namespace {

constexpr double kFar = 1000;  // m

/// The mesh file that an entry names, relative to the world file; empty when it names none.
std::string meshFile(JsonEntry& entry) {
  const std::string name = entry.text("mesh", "");
  if (name.empty()) return "";
  const auto file = entry.folder() / name;
  if (!std::filesystem::is_regular_file(file)) entry.fail("mesh", "no such file: " + file.string());
  return file.string();
}

Side side(JsonEntry& entry) {
  return valueOf(kSideWords, entry.choice("side", std::nullopt, allWords(kSideWords)));
}

Doorway doorway(JsonEntry& entry, double wall_height) {
  Doorway out;
  out.place = entry.place();
  out.side = side(entry);
  out.at_m = entry.number("at_m", std::nullopt, -kFar, kFar);
  out.width_m = entry.number("width_m", out.width_m, 0.3, 100);
  out.height_m = entry.number("height_m", std::min(out.height_m, wall_height), 0.5, wall_height);
  out.door = valueOf(kDoorWords, entry.choice("door", "none", allWords(kDoorWords)));
  out.color = entry.color("color", out.color);
  out.mesh_file = meshFile(entry);
  if (!out.mesh_file.empty() && out.door != DoorState::kClosed)
    entry.fail("mesh", "only a closed door can be a mesh");
  entry.finish();
  return out;
}

Poster poster(JsonEntry& entry) {
  Poster out;
  out.side = side(entry);
  out.at_m = entry.number("at_m", std::nullopt, -kFar, kFar);
  out.z_m = entry.number("z_m", out.z_m, 0, 20);
  out.width_m = entry.number("width_m", out.width_m, 0.05, 20);
  out.height_m = entry.number("height_m", out.height_m, 0.05, 20);
  out.variant = entry.integer("variant", 0, 0, 1000000);
  out.pattern = entry.choice("pattern", out.pattern, {out.pattern, kChessboardPattern});
  entry.finish();
  return out;
}

Material surface(JsonEntry entry, const Material& fallback) {
  Material out = fallback;
  out.pattern = entry.choice("pattern", fallback.pattern, texturePatterns());
  out.rgb = entry.color("color", fallback.rgb);
  out.size_m = entry.number("size_m", fallback.size_m, 0.05, 100);
  entry.finish();
  return out;
}

Room room(JsonEntry& entry, double wall_height) {
  Room out;
  out.place = entry.place();
  out.name = entry.text("name", "");
  const auto corner = entry.numbers("corner_m", 2), size = entry.numbers("size_m", 2);
  for (const double edge : size)
    if (edge < 0.5 || edge > kFar) entry.fail("size_m", "edges must be in [0.5, 1000] m");
  out.min_m = {corner[0], corner[1]};
  out.max_m = out.min_m + Eigen::Vector2d(size[0], size[1]);
  out.wall = surface(entry.child("wall"), {"plaster", {0.86, 0.84, 0.78}, 2.0, 0});
  out.floor = surface(entry.child("floor"), {"carpet", {0.42, 0.44, 0.47}, 1.3, 0});
  for (auto& item : entry.children("doorways")) out.doorways.push_back(doorway(item, wall_height));
  for (auto& item : entry.children("posters")) out.posters.push_back(poster(item));
  entry.finish();
  return out;
}

Eigen::Vector3d bottomCentre(JsonEntry& entry) {
  const auto at = entry.numbers("at_m", 2);
  return {at[0], at[1], entry.number("z_m", 0, 0, 20)};
}

double yaw(JsonEntry& entry) {
  return kDegree * entry.number("yaw_deg", 0, -360, 360);
}

FurnitureMove furnitureMove(JsonEntry& entry, const std::vector<FurnitureMove>& before) {
  FurnitureMove out;
  out.at_s = entry.number("at_s", std::nullopt, 0, 1e5);
  if (!before.empty() && out.at_s <= before.back().at_s) entry.fail("at_s", "must come after the move before it");
  out.at_m = bottomCentre(entry);
  out.yaw_rad = yaw(entry);
  entry.finish();
  return out;
}

Furniture furniture(JsonEntry& entry) {
  Furniture out;
  out.place = entry.place();
  out.model = entry.choice("model", std::nullopt, furnitureModels());
  out.at_m = bottomCentre(entry);
  out.yaw_rad = yaw(entry);
  if (entry.has("size_m")) {
    const auto size = entry.numbers("size_m", 3);
    for (const double edge : size)
      if (edge < 0.01 || edge > 100) entry.fail("size_m", "edges (w, d, h) must be in [0.01, 100] m");
    out.size_m = Eigen::Vector3d(size[0], size[1], size[2]);
  }
  if (entry.has("color")) out.color = entry.color("color", {});
  out.shape = entry.integer("shape", 0, 0, 1000000);
  out.mesh_file = meshFile(entry);
  for (auto& item : entry.children("moves")) out.moves.push_back(furnitureMove(item, out.moves));
  entry.finish();
  return out;
}

Person person(JsonEntry& entry) {
  Person out;
  out.place = entry.place();
  out.path_m = entry.path("path_m");
  out.speed_m_s = entry.number("speed_m_s", out.speed_m_s, 0.05, 3);
  out.start_s = entry.number("start_s", 0, 0, 1e5);
  out.yaw_rad = yaw(entry);
  out.sits = entry.flag("sits", false);
  if (out.sits && out.path_m.size() != 1) entry.fail("path_m", "a sitting person has one point");
  out.seat_height_m = entry.number("seat_height_m", out.seat_height_m, 0.2, 1);
  out.height_m = entry.number("height_m", out.height_m, 1, 2.3);
  out.shirt = entry.color("shirt", out.shirt);
  out.trousers = entry.color("trousers", out.trousers);
  out.skin = entry.color("skin", out.skin);
  out.hair = entry.color("hair", out.hair);
  out.mesh_file = meshFile(entry);
  entry.finish();
  return out;
}

RobotPathSpec robot(JsonEntry entry) {
  RobotPathSpec out;
  out.place = entry.place();
  out.path_m = entry.path("path_m");
  out.closed = entry.flag("closed", false);
  if (out.path_m.size() < (out.closed ? 3 : 2))
    entry.fail("path_m", "needs at least 2 points, 3 when closed");
  out.max_speed_m_s = entry.number("max_speed_m_s", out.max_speed_m_s, 0.01, 5);
  out.max_turn_rad_s = kDegree * entry.number("max_turn_deg_s", out.max_turn_rad_s / kDegree, 1, 360);
  out.acceleration_m_s2 = entry.number("acceleration_m_s2", out.acceleration_m_s2, 0.01, 10);
  out.radius_m = entry.number("radius_m", out.radius_m, 0, 2);
  entry.finish();
  return out;
}

HandheldSpec handheld(JsonEntry entry) {
  HandheldSpec out;
  out.place = entry.place();
  out.closed = entry.flag("closed", false);
  out.speed_m_s = entry.number("speed_m_s", out.speed_m_s, 0.01, 3);
  for (auto& item : entry.children("views")) {
    const auto at = item.numbers("at_m", 3), look = item.numbers("look_at_m", 3);
    out.keys.push_back({{at[0], at[1], at[2]}, {look[0], look[1], look[2]}});
    if ((out.keys.back().look_at_m - out.keys.back().at_m).head<2>().norm() < 0.05)
      item.fail("look_at_m", "must not be right above or below at_m");
    item.finish();
  }
  if (out.keys.size() < (out.closed ? 3 : 2)) entry.fail("views", "needs at least 2 views, 3 when closed");
  entry.finish();
  return out;
}

World world(JsonEntry& entry) {
  World out;
  out.name = entry.text("name", std::nullopt);
  if (out.name.empty() || out.name.find_first_of("/\\ ") != std::string::npos)
    entry.fail("name", "must be usable as a file name");
  entry.text("comment", "");
  if (entry.has("duration_s")) out.duration_s = entry.number("duration_s", 0, 0.1, 1e5);
  out.wall_height_m = entry.number("wall_height_m", out.wall_height_m, 0.5, 20);
  out.wall_thickness_m = entry.number("wall_thickness_m", out.wall_thickness_m, 0.02, 2);
  out.light = entry.number("light", out.light, 0.05, 2);
  for (auto& item : entry.children("rooms")) out.rooms.push_back(room(item, out.wall_height_m));
  if (out.rooms.empty()) entry.fail("rooms", "a world needs at least one room");
  for (auto& item : entry.children("furniture")) out.furniture.push_back(furniture(item));
  for (auto& item : entry.children("people")) out.people.push_back(person(item));
  if (entry.has("robot") == entry.has("handheld"))
    entry.fail("robot", "either robot or handheld must be given");
  if (entry.has("robot")) out.robot = robot(entry.child("robot"));
  if (entry.has("handheld")) out.handheld = handheld(entry.child("handheld"));
  readSensors(entry.child("sensors"), out);
  entry.finish();
  return out;
}

}  // namespace

World parseWorld(const std::string& text, const std::string& name) {
  JsonEntry entry(parseJson<nlohmann::json, ConfigError>(text, name, true), name, "");
  World out = world(entry);
  out.file = name;
  checkWorld(out);
  return out;
}

World readWorld(const std::filesystem::path& file) {
  return parseWorld(readTextFile(file), file.string());
}

}  // namespace roomgraph
