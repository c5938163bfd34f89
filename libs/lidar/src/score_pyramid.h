// SPDX-License-Identifier: BSD-3-Clause
// Pyramid of cell maxima: upper bounds on match scores for branch and bound.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "probability_grid.h"

namespace roomgraph {

/// Level h holds, for each cell, the largest probability in the square of 2^h x 2^h cells that starts there:
/// an upper bound on the score of all shifts in that square (Hess et al. 2016, Eq. 14).
class ScorePyramid {
 public:
  ScorePyramid() = default;
  ScorePyramid(const ProbabilityGrid& grid, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }
  double cellSize() const { return cell_m_; }
  const Eigen::Vector2d& corner() const { return corner_; }
  /// Probability times 255.
  std::uint8_t at(int level, int ix, int iy) const { return levels_[static_cast<std::size_t>(level)].at(ix, iy); }
  struct Cell {
    int x, y;
  };
  /// Of these cells, all shifted by as many.
  int sum(int level, std::span<const Cell> cells, const Cell& shift) const;
  /// The same at the corners of a square: at `shift`, `side` above it, `side` to the right, and both.
  std::array<int, 4> sumsAtCorners(int level, std::span<const Cell> cells, const Cell& shift, int side) const;

 private:
  static constexpr std::uint8_t kOutside = static_cast<std::uint8_t>(ProbabilityGrid::kMin * 255.f);
  struct Level {
    int width = 0, height = 0;
    int offset_x = 0, offset_y = 0;  ///< stored cell (0, 0) is cell (-offset_x, -offset_y) of the grid
    std::vector<std::uint8_t> cells;

    bool holds(int ix, int iy) const {
      const int x = ix + offset_x, y = iy + offset_y;
      return x >= 0 && y >= 0 && x < width && y < height;
    }
    std::size_t index(int ix, int iy) const {
      return static_cast<std::size_t>(iy + offset_y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(ix + offset_x);
    }
    std::uint8_t at(int ix, int iy) const { return holds(ix, iy) ? cells[index(ix, iy)] : kOutside; }
  };
  static Level coarser(const Level& fine, int half);

  double cell_m_ = 1;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  std::vector<Level> levels_;
};

/// Pyramids of the grids that were asked for last. One is several times as large as its grid, and soon made again.
class RecentPyramids {
 public:
  /// Of so many levels; at most `most` are kept.
  RecentPyramids(int levels, std::size_t most) : levels_(levels), most_(most) {}
  /// That of a finished grid with a number of its own; valid until the next call.
  const ScorePyramid& of(std::size_t number, const ProbabilityGrid& grid);
  bool holds(std::size_t number) const;
  void clear() { kept_.clear(); }

 private:
  int levels_;
  std::size_t most_;
  std::deque<std::pair<std::size_t, ScorePyramid>> kept_;  ///< the latest first
};

}  // namespace roomgraph
