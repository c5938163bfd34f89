// SPDX-License-Identifier: BSD-3-Clause
// Walls and objects as a coloured mesh in PLY.
#include "exporters.h"
#include "roomgraph/maptools/grid_outlines.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

constexpr double kWallHeight_m = 1;
const char* const kWallColor = "58 70 87";

/// Vertices and faces as lines of text.
struct MeshText {
  std::string vertices, faces;
  std::size_t vertex_count = 0, face_count = 0;

  void vertex(const Eigen::Vector2d& at, double z, const std::string& color) {
    vertices += decimals(at.x(), 4) + " " + decimals(at.y(), 4) + " " + decimals(z, 4) + " " + color + "\n";
    ++vertex_count;
  }
  void face(const std::vector<std::size_t>& corners) {
    faces += std::to_string(corners.size());
    for (const std::size_t corner : corners) faces += " " + std::to_string(corner);
    faces += "\n";
    ++face_count;
  }
  /// Upright sides above a closed polygon; its lower corners have even numbers from the returned one.
  std::size_t sides(const Polygon2& polygon, double low, double high, const std::string& color) {
    const std::size_t first = vertex_count, count = polygon.size();
    for (const auto& corner : polygon) {
      vertex(corner, low, color);
      vertex(corner, high, color);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t a = first + 2 * i, b = first + 2 * ((i + 1) % count);
      face({a, b, b + 1, a + 1});
    }
    return first;
  }
};

std::string rgbOf(const std::string& color) {
  const auto value = std::stoul(color.substr(1), nullptr, 16);
  return std::to_string(value >> 16) + " " + std::to_string(value >> 8 & 255) + " " +
         std::to_string(value & 255);
}

void addPrism(const Landmark& landmark, const std::string& color, MeshText& mesh) {
  const Polygon2 polygon = footprintOf(landmark);
  const double low = landmark.position.z(), high = low + landmark.shape.height;
  const std::size_t first = mesh.sides(polygon, low, high, color);
  std::vector<std::size_t> top, bottom;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    top.push_back(first + 2 * i + 1);
    bottom.push_back(first + 2 * (polygon.size() - 1 - i));
  }
  mesh.face(top);
  mesh.face(bottom);
}

}  // namespace

std::string plyText(const CSemanticMap& map, const ObjectDatabase& database) {
  MeshText mesh;
  for (const auto& wall : simplified(outlinesOf(gridOf(map), isOccupiedCell), outlineTolerance(gridOf(map))))
    mesh.sides(wall, 0, kWallHeight_m, kWallColor);
  for (const auto& landmark : map.landmarks)
    addPrism(landmark, rgbOf(colorOf(database, landmark.class_name)), mesh);
  return "ply\nformat ascii 1.0\ncomment roomgraph map, world, m\nelement vertex " +
         std::to_string(mesh.vertex_count) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nelement face " +
         std::to_string(mesh.face_count) + "\nproperty list uchar int vertex_indices\nend_header\n" +
         mesh.vertices + mesh.faces;
}

}  // namespace roomgraph
