// SPDX-License-Identifier: BSD-3-Clause
// Grid, path and objects of a map as messages for RViz.
#include <algorithm>
#include <array>
#include <cmath>

#include "bag_writer.h"
#include "byte_writer.h"
#include "message_writing.h"
#include "roomgraph/bags/bag_export.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

const std::string kMapFrame = "map";

enum MarkerType : std::int32_t { kBox = 1, kCylinder = 3, kText = 9 };

std::string gridBytes(const mrpt::maps::COccupancyGridMap2D& grid, std::int64_t t_ns) {
  constexpr float kUnknown = 0.01f;  // this near to even chances
  const auto columns = grid.getSizeX(), rows = grid.getSizeY();
  Pose3 origin = Pose3::Identity();
  origin.translation() = Eigen::Vector3d(grid.getXMin(), grid.getYMin(), 0);
  bags::ByteWriter out;
  out.header(t_ns, kMapFrame).time(t_ns);
  out.put(grid.getResolution(), static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows))
      .pose(origin);
  out.put(static_cast<std::uint32_t>(columns * rows));
  for (unsigned y = 0; y < rows; ++y)
    for (unsigned x = 0; x < columns; ++x) {
      const float free = grid.getCell(static_cast<int>(x), static_cast<int>(y));
      const bool unknown = std::abs(free - 0.5f) < kUnknown;
      out.put(unknown ? std::int8_t{-1} : static_cast<std::int8_t>(std::lround(100 * (1 - free))));
    }
  return out.take();
}

std::string pathBytes(const std::vector<StampedPose>& poses, std::int64_t t_ns) {
  bags::ByteWriter out;
  out.header(t_ns, kMapFrame).put(static_cast<std::uint32_t>(poses.size()));
  for (const auto& pose : poses) out.header(std::llround(1e9 * pose.t), kMapFrame).pose(pose.pose);
  return out.take();
}

// A colour of its own for each class, from its name: hues around the circle.
std::array<float, 3> colorOf(const std::string& class_name) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : class_name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
  const float hue = static_cast<float>(hash % 360u) / 60.f;
  const auto part = [&](float shift) {
    return std::clamp(std::abs(std::fmod(hue + shift, 6.f) - 3.f) - 1.f, 0.f, 1.f);
  };
  return {part(0), part(4), part(2)};
}

struct Marker {
  std::string group;
  int id = 0;
  MarkerType type = kBox;
  Pose3 pose = Pose3::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::array<float, 3> color{};
  float opacity = 1;
  std::string text;
};

void append(bags::ByteWriter& out, const Marker& marker, std::int64_t t_ns) {
  out.header(t_ns, kMapFrame).text(marker.group);
  out.put(std::int32_t{marker.id}, std::int32_t{marker.type}, std::int32_t{0}).pose(marker.pose);
  out.put(marker.scale.x(), marker.scale.y(), marker.scale.z());
  out.put(marker.color[0], marker.color[1], marker.color[2], marker.opacity);
  out.put(std::int32_t{0}, std::int32_t{0}, std::uint8_t{0});     // for ever; not locked to its frame
  out.put(std::uint32_t{0}, std::uint32_t{0}).text(marker.text);  // neither points nor colours
  out.text("").put(std::uint8_t{0});                              // no mesh
}

std::string landmarkBytes(const std::vector<Landmark>& landmarks, std::int64_t t_ns) {
  constexpr double kTextHeight_m = 0.2, kThinnest_m = 0.05;
  bags::ByteWriter out;
  out.put(static_cast<std::uint32_t>(2 * landmarks.size()));
  for (const auto& landmark : landmarks) {
    const auto& shape = landmark.shape;
    Marker body{landmark.class_name, static_cast<int>(landmark.id.value),
                shape.kind == ShapeKind::kCylinder ? kCylinder : kBox, landmark.worldFromObject()};
    body.pose = body.pose * Eigen::Translation3d(0, 0, 0.5 * shape.height);
    body.scale = Eigen::Vector3d(shape.depth, shape.width, shape.height).cwiseMax(kThinnest_m);
    body.color = colorOf(landmark.class_name);
    body.opacity = static_cast<float>(std::clamp(landmark.existence, 0.3, 0.8));
    append(out, body, t_ns);
    Marker label{"labels", body.id, kText,
                 body.pose * Eigen::Translation3d(0, 0, 0.5 * shape.height + kTextHeight_m)};
    label.scale = Eigen::Vector3d(0, 0, kTextHeight_m);
    label.color = {1, 1, 1};
    char share[32];
    std::snprintf(share, sizeof share, " %.2f", landmark.existence);
    label.text = landmark.class_name + " #" + std::to_string(body.id) + share;
    append(out, label, t_ns);
  }
  return out.take();
}

}  // namespace

BagExportResult exportResult(const std::filesystem::path& result, const std::filesystem::path& bag) {
  const auto file = std::filesystem::is_directory(result) ? result / "map.rgmap" : result;
  const CSemanticMap map = loadMap(file);
  requireOther(bag, {file});
  const auto& poses = map.world_from_robot;
  // Messages need a time that is not zero.
  const std::int64_t begin =
      std::max<std::int64_t>(1, poses.empty() ? 1 : std::llround(1e9 * poses.front().t));
  bags::BagWriter out(bag);
  if (map.occupancy)
    out.write("/map", "nav_msgs/OccupancyGrid", begin, gridBytes(*map.occupancy, begin), true);
  out.write("/path", "nav_msgs/Path", begin, pathBytes(poses, begin), true);
  out.write("/landmarks", "visualization_msgs/MarkerArray", begin, landmarkBytes(map.landmarks, begin), true);
  for (const auto& pose : poses) {
    const auto t = static_cast<std::int64_t>(std::llround(1e9 * pose.t));
    out.write("/tf", "tf2_msgs/TFMessage", t,
              bags::transformsBytes({{kMapFrame, "base_link", pose.pose}}, t));
  }
  out.finish();
  BagExportResult told{out.messages(), {}};
  if (!map.occupancy) told.warnings.push_back(file.string() + ": no occupancy grid in it");
  return told;
}

}  // namespace roomgraph
