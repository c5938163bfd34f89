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
        stored_{0, 0, width, height},
        cells_(std::move(cells)),
        touched_(cells_.size(), 0) {}

  /// Adds a scan seen from `grid_from_robot`: the cells of the returns are hit, those on the way there
  /// missed, each at most once.
  void insert(const PlanarScan& scan, const Pose2& grid_from_robot, const GridUpdate& update);
  /// No scan comes any more: only the cells between those that scans touched are kept, in half the memory, and nothing that
  /// insertion needs. What the grid says stays the same.
  void finish();

  double cellSize() const { return cell_m_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Corner of cell (0, 0), m.
  const Eigen::Vector2d& corner() const { return corner_; }
  /// Cells that are stored, a part of all: the others were never seen.
  struct Block {
    int x0 = 0, y0 = 0, width = 0, height = 0;
    bool holds(int ix, int iy) const { return ix >= x0 && iy >= y0 && ix < x0 + width && iy < y0 + height; }
  };
  const Block& storedBlock() const { return stored_; }
  /// kMin outside and where nothing was seen.
  float at(int ix, int iy) const { return stored_.holds(ix, iy) ? std::max(kMin, stored(ix, iy)) : kMin; }
  /// at() of the stored cells times 255, row by row.
  std::vector<std::uint8_t> bytes() const;
  /// Whether a scan ever touched the cell.
  bool known(int ix, int iy) const { return stored_.holds(ix, iy) && stored(ix, iy) > 0; }
  /// A point that is not finite or too far away gets a cell far outside.
  Eigen::Vector2i cellOf(const Eigen::Vector2d& point) const;

  /// Bicubic (Catmull-Rom) interpolation between cell centres at a point (m); continuous gradient (1/m).
  /// kMin, without a slope, for a point that is not finite.
  double interpolate(const Eigen::Vector2d& point, Eigen::Vector2d* gradient = nullptr) const;

 private:
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy - stored_.y0) * static_cast<std::size_t>(stored_.width) +
           static_cast<std::size_t>(ix - stored_.x0);
  }
  float stored(int ix, int iy) const {
    return values_.empty() ? cells_[index(ix, iy)] : values_[codes_[index(ix, iy)]];
  }
  Block knownBlock() const;
  void encode();
  void growToContain(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  void update(int ix, int iy, float odds_factor);
  void missAlong(Eigen::Vector2i from, const Eigen::Vector2i& to, float odds_factor);

  double cell_m_;
  int width_ = 0, height_ = 0;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  Block stored_;
  std::vector<float> cells_;            ///< of the block, row by row: probability, 0: never seen; empty when encoded
  std::vector<float> values_;           ///< that occur in a finished grid
  std::vector<std::uint16_t> codes_;    ///< of the block: which of the values each cell has
  std::vector<std::uint16_t> touched_;  ///< number of the insertion that last changed the cell; empty when finished
  std::uint16_t insertion_ = 0;
  bool finished_ = false;
};

}  // namespace roomgraph
