// SPDX-License-Identifier: BSD-3-Clause
// Assembly of the scene, extent of its content, and grid spacing.
#include "scene.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/rendering/triangle_set.h"

namespace roomgraph {

std::string inWords(std::string class_name) {
  std::replace(class_name.begin(), class_name.end(), '_', ' ');
  return class_name;
}

Eigen::AlignedBox3d contentBounds(const CSemanticMap& map) {
  Eigen::AlignedBox3d box;
  if (map.occupancy) {
    const auto& grid = *map.occupancy;
    for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
      for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
        if (isKnown(grid.getCell(x, y)))
          box.extend(Eigen::Vector3d(static_cast<double>(grid.idx2x(static_cast<std::size_t>(x))),
                                     static_cast<double>(grid.idx2y(static_cast<std::size_t>(y))), 0));
  }
  for (const auto& landmark : map.landmarks) {
    for (const auto& corner : footprintInWorld(landmark)) {
      box.extend(corner);
      box.extend(corner + Eigen::Vector3d(0, 0, landmark.shape.height));
    }
  }
  for (const auto& stamped : map.world_from_robot) box.extend(Eigen::Vector3d(stamped.pose.translation()));
  if (box.isEmpty()) box.extend(Eigen::Vector3d(0, 0, 0));
  for (int k = 0; k < 2; ++k) {
    const double missing = 2 - box.sizes()[k];
    if (missing > 0) box.min()[k] -= missing / 2, box.max()[k] += missing / 2;
  }
  return box;
}

std::vector<Eigen::Vector3d> contentPoints(const CSemanticMap& map) {
  std::vector<Eigen::Vector3d> points;
  if (map.occupancy) {
    const auto& grid = *map.occupancy;
    const int width = static_cast<int>(grid.getSizeX());
    for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y) {
      int first = 0, last = width - 1;
      while (first < width && !isKnown(grid.getCell(first, y))) ++first;
      while (last > first && !isKnown(grid.getCell(last, y))) --last;
      if (first == width) continue;
      for (const int x : {first, last})
        points.emplace_back(static_cast<double>(grid.idx2x(static_cast<std::size_t>(x))),
                            static_cast<double>(grid.idx2y(static_cast<std::size_t>(y))), 0);
    }
  }
  for (const auto& landmark : map.landmarks)
    for (const auto& corner : footprintInWorld(landmark))
      for (const double height : {0.0, landmark.shape.height})
        points.push_back(corner + Eigen::Vector3d(0, 0, height));
  for (const auto& stamped : map.world_from_robot) points.push_back(stamped.pose.translation());
  const Eigen::AlignedBox3d box = contentBounds(map);
  if (points.size() < 3 || !map.occupancy) points.insert(points.end(), {box.min(), box.max()});
  return points;
}

double contentExtent(const CSemanticMap& map) {
  return contentBounds(map).sizes().head<2>().maxCoeff();
}

double lineWidth(const CSemanticMap& map) {
  return std::clamp(contentExtent(map) * 0.0028, 0.012, 0.2);
}

double gridStep(double extent_m) {
  const double wanted = extent_m / 12;
  double step = 1;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0})
      if (step * factor >= wanted) return step * factor;
    step *= 10;
  }
}

namespace {

constexpr double kSightHeight = 0.05;  ///< above the path

/// From the robot to what it measures at this moment.
void addSightLines(const MapPicture& picture, const ObjectDatabase& database,
                   mrpt::opengl::COpenGLScene& scene, double width) {
  if (picture.in_sight.empty() || picture.shown.world_from_robot.empty()) return;
  Eigen::Vector3d robot = picture.shown.world_from_robot.back().pose.translation();
  robot.z() = kSightHeight + (picture.shown.planar ? 0 : robot.z());
  TriangleSet mesh;
  for (const auto& landmark : picture.shown.landmarks) {
    const auto& seen = picture.in_sight;
    if (std::find(seen.begin(), seen.end(), landmark.id) == seen.end()) continue;
    const auto color = palette::mix(palette::ofClass(database, landmark.class_name), {0, 0, 0}, 0.25);
    mesh.ribbon(robot, landmark.position + Eigen::Vector3d(0, 0, kSightHeight), width, color);
  }
  scene.insert(mesh.object("sight"));
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr buildScene(const MapPicture& picture, const ObjectDatabase& database) {
  auto scene = mrpt::opengl::COpenGLScene::Create();
  scene->getViewport()->setCustomBackgroundColor(mrpt::img::TColorf(palette::kUnknown));
  const double width = lineWidth(picture.whole);
  addFloor(picture.shown, *scene);
  addGridLines(picture.whole, *scene);
  addWalls(picture.shown, *scene);
  addPath(picture.shown, *scene, width);
  addLandmarks(picture.shown, database, *scene, width);
  addSightLines(picture, database, *scene, width);
  return scene;
}

}  // namespace roomgraph
