// SPDX-License-Identifier: BSD-3-Clause
// Landmarks as translucent boxes with front arrows.
#include <algorithm>
#include <cmath>

#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/rendering/triangle_set.h"

namespace roomgraph {
namespace {

constexpr int kTopAlpha = 190, kSideAlpha = 150;
constexpr double kObjectLift = 0.03;  ///< above floor and path

std::vector<Eigen::Vector3d> lifted(std::vector<Eigen::Vector3d> corners, double height) {
  for (auto& corner : corners) corner.z() += height;
  return corners;
}

/// Brightness of an upright face, as if the light came from the south-west.
double shade(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double angle = std::atan2(to.y() - from.y(), to.x() - from.x()) - M_PI / 2;
  return 0.5 + 0.5 * std::cos(angle - M_PI * 1.25);
}

void addBox(const std::vector<Eigen::Vector3d>& base, double height, const palette::TColor& color,
            TriangleSet& mesh) {
  const auto top = lifted(base, height);
  const auto dark = palette::mix(color, {0, 0, 0}, 0.3);
  for (std::size_t i = 0; i < base.size(); ++i) {
    const std::size_t j = (i + 1) % base.size();
    const auto side = palette::mix(dark, color, shade(base[i], base[j]));
    mesh.polygon({base[i], base[j], top[j], top[i]}, palette::withAlpha(side, kSideAlpha));
  }
  mesh.polygon(top, palette::withAlpha(color, kTopAlpha));
}

/// Small triangle outside the front's middle.
void addFrontArrow(const Landmark& landmark, double height, double size, const palette::TColor& color,
                   TriangleSet& mesh) {
  const double front = landmark.shape.depth / 2;
  const auto at = [&](double forward, double left) {
    return Eigen::Vector3d(landmark.worldFromObject() * Eigen::Vector3d(forward, left, height));
  };
  mesh.triangle(at(front + 1.6 * size, 0), at(front + 0.4 * size, 0.8 * size),
                at(front + 0.4 * size, -0.8 * size), color);
}

}  // namespace

std::vector<Eigen::Vector3d> footprintInWorld(const Landmark& landmark) {
  std::vector<Eigen::Vector3d> corners;
  for (const auto& corner : footprintAt(planarPart(landmark.worldFromObject()), landmark.shape))
    corners.emplace_back(corner.x(), corner.y(), landmark.position.z());
  return corners;
}

void addLandmarks(const CSemanticMap& map, const ObjectDatabase& database, mrpt::opengl::COpenGLScene& scene,
                  std::optional<double> line_width) {
  const double width = std::min(line_width ? *line_width : lineWidth(map), 0.04);
  for (const auto& landmark : map.landmarks) {
    const auto color = palette::ofClass(database, landmark.class_name);
    const auto edge = palette::mix(color, {0, 0, 0}, 0.25);
    const auto base = lifted(footprintInWorld(landmark), kObjectLift);
    const double height = std::max(landmark.shape.height, 0.02);
    TriangleSet mesh;
    mesh.outline(base, width, edge);
    addBox(base, height, color, mesh);
    mesh.outline(lifted(base, height + 0.004), width, edge);
    if (landmark.has_yaw) addFrontArrow(landmark, height + 0.01, std::max(3 * width, 0.1), edge, mesh);
    auto object = mesh.object(landmark.class_name + " " + std::to_string(landmark.id.value));
    // The renderer sorts by this point: translucent things must come after what is behind them.
    const Eigen::Vector3d center = landmark.position + Eigen::Vector3d(0, 0, height);
    object->setLocalRepresentativePoint(
        {static_cast<float>(center.x()), static_cast<float>(center.y()), static_cast<float>(center.z())});
    // Only the near faces: what is inside and behind shows through once.
    object->cullFaces(mrpt::opengl::TCullFace::BACK);
    scene.insert(object);
  }
}

}  // namespace roomgraph
