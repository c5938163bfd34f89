// SPDX-License-Identifier: BSD-3-Clause
// Writer of world files: the counterpart of their parser.
#include <cmath>

#include "json_numbers.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/simulation/world_file.h"
#include "world_names.h"

namespace roomgraph {
namespace {

using WorldJson = nlohmann::ordered_json;

constexpr double kStepsPerUnit = 1e6;

double neat(double value) {
  return roundedTo(value, kStepsPerUnit);
}

WorldJson neat(const Eigen::VectorXd& values) {
  return numbersJson(values, kStepsPerUnit);
}

std::string colorText(const std::array<double, 3>& rgb) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(std::lround(255 * rgb[0])) & 255u,
                static_cast<unsigned>(std::lround(255 * rgb[1])) & 255u,
                static_cast<unsigned>(std::lround(255 * rgb[2])) & 255u);
  return text;
}

WorldJson degrees(double radians) {
  return neat(radians / kDegree);
}

WorldJson pathJson(const std::vector<Eigen::Vector2d>& points) {
  WorldJson out = WorldJson::array();
  for (const auto& point : points) out.push_back(neat(point));
  return out;
}

WorldJson surfaceJson(const Material& material) {
  return {{"pattern", material.pattern}, {"color", colorText(material.rgb)}, {"size_m", neat(material.size_m)}};
}

WorldJson roomJson(const Room& room) {
  WorldJson out{{"name", room.name},
                {"corner_m", neat(room.min_m)},
                {"size_m", neat(room.max_m - room.min_m)},
                {"wall", surfaceJson(room.wall)},
                {"floor", surfaceJson(room.floor)}};
  for (const auto& doorway : room.doorways) {
    WorldJson item{{"side", wordOf(kSideWords, doorway.side)}, {"at_m", neat(doorway.at_m)},
                   {"width_m", neat(doorway.width_m)},         {"height_m", neat(doorway.height_m)},
                   {"door", wordOf(kDoorWords, doorway.door)}, {"color", colorText(doorway.color)}};
    if (!doorway.mesh_file.empty()) item["mesh"] = doorway.mesh_file;
    out["doorways"].push_back(item);
  }
  for (const auto& poster : room.posters) {
    WorldJson item{{"side", wordOf(kSideWords, poster.side)},
                   {"at_m", neat(poster.at_m)},
                   {"z_m", neat(poster.z_m)},
                   {"width_m", neat(poster.width_m)},
                   {"height_m", neat(poster.height_m)},
                   {"variant", poster.variant}};
    if (poster.pattern != Poster{}.pattern) item["pattern"] = poster.pattern;
    out["posters"].push_back(item);
  }
  return out;
}

WorldJson furnitureJson(const Furniture& item) {
  WorldJson out{{"model", item.model},
                {"at_m", neat(item.at_m.head<2>())},
                {"z_m", neat(item.at_m.z())},
                {"yaw_deg", degrees(item.yaw_rad)}};
  if (item.size_m) out["size_m"] = neat(*item.size_m);
  if (item.color) out["color"] = colorText(*item.color);
  if (item.shape != 0) out["shape"] = item.shape;
  if (!item.mesh_file.empty()) out["mesh"] = item.mesh_file;
  for (const auto& move : item.moves)
    out["moves"].push_back({{"at_s", neat(move.at_s)},
                            {"at_m", neat(move.at_m.head<2>())},
                            {"z_m", neat(move.at_m.z())},
                            {"yaw_deg", degrees(move.yaw_rad)}});
  return out;
}

WorldJson personJson(const Person& person) {
  WorldJson out{{"path_m", pathJson(person.path_m)},
                {"speed_m_s", neat(person.speed_m_s)},
                {"start_s", neat(person.start_s)},
                {"yaw_deg", degrees(person.yaw_rad)},
                {"sits", person.sits},
                {"seat_height_m", neat(person.seat_height_m)},
                {"height_m", neat(person.height_m)},
                {"shirt", colorText(person.shirt)},
                {"trousers", colorText(person.trousers)},
                {"skin", colorText(person.skin)},
                {"hair", colorText(person.hair)}};
  if (!person.mesh_file.empty()) out["mesh"] = person.mesh_file;
  return out;
}

WorldJson robotJson(const RobotPathSpec& robot) {
  return {{"path_m", pathJson(robot.path_m)},
          {"closed", robot.closed},
          {"max_speed_m_s", neat(robot.max_speed_m_s)},
          {"max_turn_deg_s", degrees(robot.max_turn_rad_s)},
          {"acceleration_m_s2", neat(robot.acceleration_m_s2)},
          {"radius_m", neat(robot.radius_m)}};
}

WorldJson handheldJson(const HandheldSpec& handheld) {
  WorldJson views = WorldJson::array();
  for (const auto& key : handheld.keys)
    views.push_back({{"at_m", neat(key.at_m)}, {"look_at_m", neat(key.look_at_m)}});
  return {{"views", views}, {"closed", handheld.closed}, {"speed_m_s", neat(handheld.speed_m_s)}};
}

WorldJson cameraJson(const CameraSpec& camera, bool robot) {
  WorldJson out{{"rate_hz", neat(camera.rate_hz)},
                {"width_px", camera.model.width},
                {"height_px", camera.model.height},
                {"focal_px", neat(camera.model.fx)},
                {"near_m", neat(camera.near_m)},
                {"far_m", neat(camera.far_m)},
                {"noise", neat(camera.noise_gain)},
                {"jpeg_quality", camera.jpeg_quality}};
  if (robot) {
    out["at_m"] = neat(camera.at_m);
    out["pitch_down_deg"] = degrees(camera.pitch_down_rad);
  }
  return out;
}

WorldJson lidarJson(const LidarSpec& lidar) {
  return {{"rate_hz", neat(lidar.rate_hz)},
          {"beams", lidar.beams},
          {"at_m", neat(lidar.at_m)},
          {"range_min_m", neat(lidar.min_m)},
          {"range_max_m", neat(lidar.max_m)},
          {"sigma_m", neat(lidar.sigma_m)},
          {"sigma_relative", neat(lidar.sigma_relative)},
          {"dropouts", neat(lidar.dropouts)}};
}

WorldJson odometryJson(const OdometrySpec& odometry) {
  return {{"rate_hz", neat(odometry.rate_hz)},
          {"scale_error", neat(odometry.scale_error)},
          {"turn_error", neat(odometry.turn_error)},
          {"drift_deg_m", degrees(odometry.drift_rad_m)},
          {"sigma_length", neat(odometry.sigma_length)},
          {"sigma_turn", neat(odometry.sigma_turn)},
          {"slips", odometry.slips},
          {"slip_m", neat(odometry.slip_m)},
          {"slip_deg", degrees(odometry.slip_rad)}};
}

WorldJson detectionsJson(const DetectionsSpec& spec) {
  WorldJson out{{"detect_probability", neat(spec.detect_probability)},
                {"min_visible", neat(spec.min_visible)},
                {"min_height_px", neat(spec.min_height_px)},
                {"jitter", neat(spec.jitter)},
                {"false_positives", neat(spec.false_positives)}};
  if (!spec.persistent) {
    out["confusion"] = neat(spec.confusion);
    return out;
  }
  out["errors"] = "persistent";
  out["mislead"] = neat(spec.mislead);
  out["duplicates"] = neat(spec.duplicates);
  out["memory_s"] = neat(spec.memory_s);
  return out;
}

}  // namespace

std::string worldText(const World& world, const std::string& comment) {
  WorldJson out{{"name", world.name}};
  if (!comment.empty()) out["comment"] = comment;
  if (world.duration_s) out["duration_s"] = neat(*world.duration_s);
  out["wall_height_m"] = neat(world.wall_height_m);
  out["wall_thickness_m"] = neat(world.wall_thickness_m);
  out["light"] = neat(world.light);
  for (const auto& room : world.rooms) out["rooms"].push_back(roomJson(room));
  for (const auto& item : world.furniture) out["furniture"].push_back(furnitureJson(item));
  for (const auto& person : world.people) out["people"].push_back(personJson(person));
  if (world.robot) out["robot"] = robotJson(*world.robot);
  if (world.handheld) out["handheld"] = handheldJson(*world.handheld);
  WorldJson& sensors = out["sensors"];
  if (world.camera) sensors["camera"] = cameraJson(*world.camera, world.robot.has_value());
  if (world.lidar) sensors["lidar"] = lidarJson(*world.lidar);
  if (world.odometry) sensors["odometry"] = odometryJson(*world.odometry);
  if (world.detections) sensors["detections"] = detectionsJson(*world.detections);
  return out.dump(1) + "\n";
}

}  // namespace roomgraph
