// SPDX-License-Identifier: BSD-3-Clause
// Maxima of squares of doubling size, level by level.
#include "score_pyramid.h"

#include <algorithm>

namespace roomgraph {

ScorePyramid::ScorePyramid(const ProbabilityGrid& grid, int levels)
    : cell_m_(grid.cellSize()), corner_(grid.corner()) {
  Level base{grid.width(), grid.height(), 0, {}};
  base.cells.reserve(static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height));
  for (int y = 0; y < base.height; ++y)
    for (int x = 0; x < base.width; ++x)
      base.cells.push_back(static_cast<std::uint8_t>(grid.at(x, y) * 255.f));
  levels_.push_back(std::move(base));
  for (int h = 1; h < levels; ++h) levels_.push_back(coarser(levels_.back(), 1 << (h - 1)));
}

// A square of 2^h cells is made of four with half its side, `half`: joined along x first, then along y.
ScorePyramid::Level ScorePyramid::coarser(const Level& fine, int half) {
  const auto width = static_cast<std::size_t>(fine.width), height = static_cast<std::size_t>(fine.height);
  const auto shift = static_cast<std::size_t>(half), wide = width + shift;
  std::vector<std::uint8_t> rows(wide * height, kOutside);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = &fine.cells[y * width];
    std::uint8_t* to = &rows[y * wide];
    std::copy_n(from, width, to);
    for (std::size_t x = 0; x < width; ++x) to[x + shift] = std::max(to[x + shift], from[x]);
  }
  Level out{fine.width + half, fine.height + half, fine.offset + half, {}};
  out.cells.assign(wide * (height + shift), kOutside);
  std::copy(rows.begin(), rows.end(), out.cells.begin());
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < wide; ++x) {
      std::uint8_t& cell = out.cells[(y + shift) * wide + x];
      cell = std::max(cell, rows[y * wide + x]);
    }
  return out;
}

}  // namespace roomgraph
