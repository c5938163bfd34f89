// SPDX-License-Identifier: BSD-3-Clause
// Truth poses, boxes, objects and calibration as text and JSON.
#include "truth_files.h"

#include <cstdarg>
#include <cstdio>

#include "json_numbers.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPerUnit = 1e4;

double rounded(double value) {
  return roundedTo(value, kPerUnit);
}

Json list(const Eigen::VectorXd& values) {
  return numbersJson(values, kPerUnit);
}

Json list(const cv::Rect& box) {
  return {box.x, box.y, box.br().x, box.br().y};
}

}  // namespace

void TruthFile::line(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  *this << text << "\n";
  check();
}

void writePose(TruthFile& file, double t, const Pose3& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  file.line("%.3f %.6f %.6f %.6f %.8f %.8f %.8f %.8f", t, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

void writeBoxes(TruthFile& file, int frame, double t, const std::vector<ObjectView>& views,
                const Scene& scene) {
  Json objects = Json::array();
  for (const auto& view : views) {
    const auto& object = scene.objects()[static_cast<std::size_t>(view.object)];
    objects.push_back({{"id", object.id},
                       {"class", object.class_name},
                       {"kind", object.kind},
                       {"bbox", list(view.box)},
                       {"visible", rounded(view.visible)},
                       {"unoccluded", rounded(view.unoccluded)},
                       {"in_frame", rounded(view.in_frame)},
                       {"px", view.px},
                       {"z_med", rounded(view.median_depth_m)},
                       {"full_bbox", list(view.full_box)}});
  }
  char stamp[32];
  std::snprintf(stamp, sizeof stamp, "%.3f", t);
  file << "{\"frame\":" << frame << ",\"t\":" << stamp << ",\"objects\":" << objects.dump() << "}\n";
}

namespace {

Json placeJson(double since_s, const Pose3& pose) {
  const Eigen::Vector3d at = pose.translation();
  return {{"since_s", rounded(since_s)},
          {"x", rounded(at.x())},
          {"y", rounded(at.y())},
          {"z", rounded(at.z())},
          {"yaw", rounded(planarPart(pose).yaw)}};
}

// Where it stood, one place after the other.
Json placesJson(const SceneObject& object, double seconds) {
  Json out = Json::array({placeJson(0, object.world_from_object)});
  for (const auto& [since_s, pose] : object.moves)
    if (since_s <= seconds) out.push_back(placeJson(since_s, pose));
  return out;
}

}  // namespace

void writeObjects(const std::filesystem::path& file, const Scene& scene, double seconds) {
  Json objects = Json::array();
  for (std::size_t i = 0; i < scene.objects().size(); ++i) {
    const SceneObject& object = scene.objects()[i];
    const Pose3& pose = scene.worldFromObject(static_cast<int>(i), seconds);
    const Eigen::Vector3d at = pose.translation();
    const Pose2 moved = planarPart(pose * object.world_from_object.inverse());
    Json footprint = Json::array();
    for (const auto& corner : object.footprint) footprint.push_back(list(moved * corner));
    Json item{{"id", object.id},
              {"class", object.class_name},
              {"kind", object.kind},
              {"model", object.model},
              {"x", rounded(at.x())},
              {"y", rounded(at.y())},
              {"z", rounded(at.z())},
              {"yaw", rounded(planarPart(pose).yaw)},
              {"size_wdh", list(object.size_wdh)},
              {"moving", object.moving},
              {"footprint", footprint},
              {"center", list(at + Eigen::Vector3d(0, 0, object.size_wdh.z() / 2))}};
    if (!object.moves.empty()) item["places"] = placesJson(object, seconds);
    if (object.moving) item["note"] = "pose and footprint at the first instant; see persons.txt";
    objects.push_back(std::move(item));
  }
  TruthFile out(file);
  out << Json{{"frame", "world: z up, origin at the robot's first pose"}, {"objects", objects}}.dump(1)
      << "\n";
  out.finish();
}

void writeCalibration(const std::filesystem::path& file, const World& world, const Scene& scene) {
  Json out;
  if (world.camera) {
    const auto& spec = *world.camera;
    out["camera"] = {{"width", spec.model.width},
                     {"height", spec.model.height},
                     {"fx", spec.model.fx},
                     {"fy", spec.model.fy},
                     {"cx", spec.model.cx},
                     {"cy", spec.model.cy},
                     {"distortion", {0, 0, 0, 0, 0}},
                     {"depth_unit_m", 0.001},
                     {"depth_registered_to_colour", true},
                     {"depth_range_m", {spec.near_m, spec.far_m}},
                     {"rate_hz", spec.rate_hz}};
    const Pose3& pose = scene.robotFromCamera();
    Json rotation = Json::array();
    for (int r = 0; r < 3; ++r)
      rotation.push_back({pose.linear()(r, 0), pose.linear()(r, 1), pose.linear()(r, 2)});
    out["robot_from_camera"] = {{"comment", "camera optical frame in the robot frame: p_robot = R p_cam + t"},
                                {"t", list(pose.translation())},
                                {"R", rotation}};
  }
  if (world.lidar) {
    const auto& spec = *world.lidar;
    out["lidar"] = {{"beams", spec.beams},
                    {"rate_hz", spec.rate_hz},
                    {"range_min_m", spec.min_m},
                    {"range_max_m", spec.max_m},
                    {"angle_first_rad", -3.141592653589793},
                    {"angle_last_rad", 3.141592653589793},
                    {"angle_increment_rad", 6.283185307179586 / (spec.beams - 1)}};
    out["robot_from_lidar"] = {{"t", list(spec.at_m)}, {"yaw", 0.0}};
  }
  if (world.robot) out["robot"] = {{"radius", world.robot->radius_m}, {"drive", "differential"}};
  if (world.odometry) out["odometry_rate_hz"] = world.odometry->rate_hz;
  TruthFile writer(file);
  writer << out.dump(1) << "\n";
  writer.finish();
}

}  // namespace roomgraph
