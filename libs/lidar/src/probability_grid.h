// SPDX-License-Identifier: BSD-3-Clause
// Growing occupancy probability grid with bicubic interpolation.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "planar_scan.h"

namespace roomgraph {

/// How strongly one scan changes a cell.
struct GridUpdate {
  double hit_probability = 0.55, miss_probability = 0.49;
};

/// Occupancy probabilities on square cells that grows as scans come in; Hess et al. 2016 (Cartographer), sec.
/// IV. Cells never seen count as nearly free, so that the surface a scan saw is a ridge with slopes on both
/// sides.
class ProbabilityGrid {
 public:
  static constexpr float kMin = 0.1f, kMax = 0.98f;

  explicit ProbabilityGrid(double cell_m) : cell_m_(cell_m) {}
  /// From a finished map: probabilities row by row from the smallest y, 0 for cells never seen.
  ProbabilityGrid(double cell_m, const Eigen::Vector2d& corner, int width, int height,
                  std::vector<float> cells)
      : cell_m_(cell_m),
        width_(width),
        height_(height),
        corner_(corner),
        cells_(std::move(cells)),
        touched_(cells_.size(), 0) {}

  /// Adds a scan seen from `grid_from_robot`: the cells of the returns are hit, those on the way there
  /// missed, each at most once.
  void insert(const PlanarScan& scan, const Pose2& grid_from_robot, const GridUpdate& update);

  double cellSize() const { return cell_m_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Corner of cell (0, 0), m.
  const Eigen::Vector2d& corner() const { return corner_; }
  /// kMin outside and where nothing was seen.
  float at(int ix, int iy) const { return inside(ix, iy) ? std::max(kMin, cells_[index(ix, iy)]) : kMin; }
  /// Whether a scan ever touched the cell.
  bool known(int ix, int iy) const { return inside(ix, iy) && cells_[index(ix, iy)] > 0; }
  /// A point that is not finite or too far away gets a cell far outside.
  Eigen::Vector2i cellOf(const Eigen::Vector2d& point) const;

  /// Bicubic (Catmull-Rom) interpolation between cell centres at a point (m); continuous gradient (1/m).
  /// kMin, without a slope, for a point that is not finite.
  double interpolate(const Eigen::Vector2d& point, Eigen::Vector2d* gradient = nullptr) const;

 private:
  bool inside(int ix, int iy) const { return ix >= 0 && iy >= 0 && ix < width_ && iy < height_; }
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(ix);
  }
  void growToContain(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  void update(int ix, int iy, float odds_factor);
  void missAlong(Eigen::Vector2i from, const Eigen::Vector2i& to, float odds_factor);

  double cell_m_;
  int width_ = 0, height_ = 0;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  std::vector<float> cells_;            ///< probability, 0: never seen
  std::vector<std::uint16_t> touched_;  ///< number of the insertion that last changed the cell
  std::uint16_t insertion_ = 0;
};

}  // namespace roomgraph
