// SPDX-License-Identifier: BSD-3-Clause
// Pyramid of cell maxima: upper bounds on match scores for branch and bound.
#pragma once

#include <cstdint>
#include <deque>
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
  std::uint8_t at(int level, int ix, int iy) const {
    const Level& l = levels_[static_cast<std::size_t>(level)];
    const int x = ix + l.offset_x, y = iy + l.offset_y;
    if (x < 0 || y < 0 || x >= l.width || y >= l.height) return kOutside;
    return l
        .cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(x)];
  }

 private:
  static constexpr std::uint8_t kOutside = static_cast<std::uint8_t>(ProbabilityGrid::kMin * 255.f);
  struct Level {
    int width = 0, height = 0;
    int offset_x = 0, offset_y = 0;  ///< stored cell (0, 0) is cell (-offset_x, -offset_y) of the grid
    std::vector<std::uint8_t> cells;
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
