// SPDX-License-Identifier: BSD-3-Clause
// Maxima of squares of doubling size, level by level.
#include "score_pyramid.h"

#include <algorithm>

namespace roomgraph {

ScorePyramid::ScorePyramid(const ProbabilityGrid& grid, int levels)
    : cell_m_(grid.cellSize()), corner_(grid.corner()) {
  const ProbabilityGrid::Block& block = grid.storedBlock();
  Level base{block.width, block.height, -block.x0, -block.y0, {}};
  base.cells.reserve(static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height));
  for (int y = block.y0; y < block.y0 + block.height; ++y)
    for (int x = block.x0; x < block.x0 + block.width; ++x)
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
  Level out{fine.width + half, fine.height + half, fine.offset_x + half, fine.offset_y + half, {}};
  out.cells.assign(wide * (height + shift), kOutside);
  std::copy(rows.begin(), rows.end(), out.cells.begin());
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < wide; ++x) {
      std::uint8_t& cell = out.cells[(y + shift) * wide + x];
      cell = std::max(cell, rows[y * wide + x]);
    }
  return out;
}

bool RecentPyramids::holds(std::size_t number) const {
  return std::any_of(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.first == number; });
}

const ScorePyramid& RecentPyramids::of(std::size_t number, const ProbabilityGrid& grid) {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.first == number; });
  if (found == kept_.end()) {
    kept_.emplace_front(number, ScorePyramid(grid, levels_));
    if (kept_.size() > most_) kept_.pop_back();
  } else {
    std::rotate(kept_.begin(), found, found + 1);
  }
  return kept_.front().second;
}

}  // namespace roomgraph
