// SPDX-License-Identifier: BSD-3-Clause
// Walk along the directed sides of cells; simplification by OpenCV.
#include "roomgraph/maptools/grid_outlines.h"

#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace roomgraph {
namespace {

// Directions of a side: right, up, left, down. The cell is on its left.
constexpr int kStepX[4] = {1, 0, -1, 0}, kStepY[4] = {0, 1, 0, -1};

/// The sides between chosen and other cells that start at each corner of the lattice, as bits by direction.
class BorderSides {
 public:
  BorderSides(const mrpt::maps::COccupancyGridMap2D& grid, const std::function<bool(float)>& chosen)
      : width_(static_cast<int>(grid.getSizeX())), height_(static_cast<int>(grid.getSizeY())) {
    sides_.assign(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1), 0);
    const auto is = [&](int x, int y) {
      return x >= 0 && y >= 0 && x < width_ && y < height_ && chosen(grid.getCell(x, y));
    };
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        if (!is(x, y)) continue;
        if (!is(x, y - 1)) add(x, y, 0);
        if (!is(x + 1, y)) add(x + 1, y, 1);
        if (!is(x, y + 1)) add(x + 1, y + 1, 2);
        if (!is(x - 1, y)) add(x, y + 1, 3);
      }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool has(int x, int y, int direction) const { return (at(x, y) >> direction & 1) != 0; }
  void remove(int x, int y, int direction) {
    sides_[index(x, y)] = static_cast<std::uint8_t>(at(x, y) & ~(1 << direction));
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x);
  }
  int at(int x, int y) const { return sides_[index(x, y)]; }
  void add(int x, int y, int direction) {
    sides_[index(x, y)] = static_cast<std::uint8_t>(at(x, y) | 1 << direction);
  }

  int width_, height_;
  std::vector<std::uint8_t> sides_;
};

// Corners (lattice) of the border that starts with a side, which is taken out.
Polygon2 walk(BorderSides& sides, int x, int y, int direction) {
  Polygon2 corners;
  while (sides.has(x, y, direction)) {
    sides.remove(x, y, direction);
    x += kStepX[direction];
    y += kStepY[direction];
    // Left first: at a corner where two cells touch, the way goes on around the same cell.
    int next = direction;
    for (const int turn : {1, 0, 3})
      if (sides.has(x, y, (direction + turn) % 4)) {
        next = (direction + turn) % 4;
        break;
      }
    if (next != direction || !sides.has(x, y, next)) corners.emplace_back(x, y);
    direction = next;
  }
  return corners;
}

}  // namespace

std::vector<Polygon2> outlinesOf(const mrpt::maps::COccupancyGridMap2D& grid,
                                 const std::function<bool(float)>& chosen) {
  BorderSides sides(grid, chosen);
  const double cell = static_cast<double>(grid.getResolution());
  const Eigen::Vector2d corner(static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin()));
  std::vector<Polygon2> out;
  // Every border has a horizontal side.
  for (int y = 0; y <= sides.height(); ++y)
    for (int x = 0; x <= sides.width(); ++x)
      for (const int direction : {0, 2}) {
        if (!sides.has(x, y, direction)) continue;
        Polygon2 border = walk(sides, x, y, direction);
        for (auto& point : border) point = corner + cell * point;
        out.push_back(std::move(border));
      }
  return out;
}

double outlineTolerance(const mrpt::maps::COccupancyGridMap2D& grid) {
  constexpr double kMost_m = 0.03, kShareOfCell = 0.6;
  return std::min(kMost_m, kShareOfCell * static_cast<double>(grid.getResolution()));
}

std::vector<Polygon2> simplified(const std::vector<Polygon2>& polygons, double tolerance_m) {
  std::vector<Polygon2> out;
  for (const auto& polygon : polygons) {
    std::vector<cv::Point2f> corners, kept;
    for (const auto& p : polygon) corners.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    cv::approxPolyDP(corners, kept, tolerance_m, true);
    if (kept.size() < 3) {  // thinner than the tolerance
      out.push_back(polygon);
      continue;
    }
    Polygon2 simple;
    for (const auto& p : kept) simple.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
    out.push_back(std::move(simple));
  }
  return out;
}

}  // namespace roomgraph
