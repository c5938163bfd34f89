// SPDX-License-Identifier: BSD-3-Clause
// Floor texture, grid lines and walls of the scene from the occupancy grid.
#include <mrpt/opengl/CTexturedPlane.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/rendering/triangle_set.h"

namespace roomgraph {
namespace {

using palette::TColor;

constexpr int kMaxTexture = 4096;      ///< px; every OpenGL driver can do this
constexpr double kGridHeight = 0.004;  ///< lines lie just above the floor
constexpr double kWallHeight = 0.35;   ///< low, so that nothing is hidden behind
constexpr float kOccupiedBelow = 0.35f;

/// Unknown cells keep the background's colour: the floor has no visible border.
TColor cellColor(float p_free) {
  if (p_free >= 0.5f)
    return palette::mix(palette::kUnknown, palette::kFree, std::min(1.0, (p_free - 0.5) / 0.3));
  return palette::mix(palette::kUnknown, palette::kOccupied, std::min(1.0, (0.5 - p_free) / 0.25));
}

/// First row = smallest y, as textures have it.
cv::Mat floorImage(const mrpt::maps::COccupancyGridMap2D& grid) {
  const int width = static_cast<int>(grid.getSizeX()), height = static_cast<int>(grid.getSizeY());
  cv::Mat image(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const TColor color = cellColor(grid.getCell(x, y));
      image.at<cv::Vec3b>(y, x) = {color.B, color.G, color.R};
    }
  }
  const double factor = static_cast<double>(kMaxTexture) / std::max(width, height);
  if (factor < 1) cv::resize(image, image, {}, factor, factor, cv::INTER_AREA);
  return image;
}

bool occupied(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y) {
  return x >= 0 && y >= 0 && x < static_cast<int>(grid.getSizeX()) && y < static_cast<int>(grid.getSizeY()) &&
         grid.getCell(x, y) < kOccupiedBelow;
}

/// The four sides and the top of one cell, leaving out sides that touch another occupied cell. Sides are
/// shaded by direction, as if the light came from the south-west.
void addCell(const mrpt::maps::COccupancyGridMap2D& grid, int x, int y, TriangleSet& mesh) {
  const double r = static_cast<double>(grid.getResolution());
  const double x0 = static_cast<double>(grid.getXMin()) + x * r,
               y0 = static_cast<double>(grid.getYMin()) + y * r;
  const auto at = [&](int i, int j, double z) { return Eigen::Vector3d(x0 + i * r, y0 + j * r, z); };
  mesh.polygon({at(0, 0, kWallHeight), at(1, 0, kWallHeight), at(1, 1, kWallHeight), at(0, 1, kWallHeight)},
               palette::kOccupied);
  const auto side = [&](int dx, int dy, double brightness, int i0, int j0, int i1, int j1) {
    if (occupied(grid, x + dx, y + dy)) return;
    mesh.polygon({at(i0, j0, 0), at(i1, j1, 0), at(i1, j1, kWallHeight), at(i0, j0, kWallHeight)},
                 palette::mix(palette::kOccupied, palette::kFree, brightness));
  };
  side(0, -1, 0.34, 0, 0, 1, 0);
  side(-1, 0, 0.24, 0, 0, 0, 1);
  side(0, 1, 0.16, 0, 1, 1, 1);
  side(1, 0, 0.20, 1, 0, 1, 1);
}

}  // namespace

void addFloor(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene) {
  if (!map.occupancy || map.occupancy->getSizeX() == 0 || map.occupancy->getSizeY() == 0) return;
  const auto& grid = *map.occupancy;
  auto plane =
      mrpt::opengl::CTexturedPlane::Create(grid.getXMin(), grid.getXMax(), grid.getYMin(), grid.getYMax());
  plane->mrpt::opengl::CRenderizableShaderTexturedTriangles::enableLight(false);
  plane->assignImage(mrpt::img::CImage(floorImage(grid), mrpt::img::DEEP_COPY));
  plane->setName("floor");
  scene.insert(plane);
}

void addGridLines(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene) {
  const Eigen::AlignedBox3d box = contentBounds(map);
  const double step = gridStep(contentExtent(map)), width = lineWidth(map) * 0.4;
  const Eigen::Vector2d low = (box.min().head<2>() / step).array().floor() * step;
  const Eigen::Vector2d high = (box.max().head<2>() / step).array().ceil() * step;
  TriangleSet mesh;
  for (double x = low.x(); x < high.x() + step / 2; x += step)
    mesh.ribbon({x, low.y(), kGridHeight}, {x, high.y(), kGridHeight}, width, palette::kGridLine);
  for (double y = low.y(); y < high.y() + step / 2; y += step)
    mesh.ribbon({low.x(), y, kGridHeight}, {high.x(), y, kGridHeight}, width, palette::kGridLine);
  scene.insert(mesh.object("metre grid"));
}

void addWalls(const CSemanticMap& map, mrpt::opengl::COpenGLScene& scene) {
  if (!map.occupancy) return;
  const auto& grid = *map.occupancy;
  TriangleSet mesh;
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x)
      if (occupied(grid, x, y)) addCell(grid, x, y, mesh);
  scene.insert(mesh.object("walls"));
}

}  // namespace roomgraph
