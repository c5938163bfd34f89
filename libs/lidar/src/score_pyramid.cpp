// SPDX-License-Identifier: BSD-3-Clause
// Maxima of squares of doubling size, level by level.
#include "score_pyramid.h"

#include <algorithm>

namespace roomgraph {

ScorePyramid::ScorePyramid(const ProbabilityGrid& grid, int levels)
    : cell_m_(grid.cellSize()), corner_(grid.corner()) {
  const ProbabilityGrid::Block& block = grid.storedBlock();
  levels_.push_back({block.width, block.height, -block.x0, -block.y0, grid.bytes()});
  for (int h = 1; h < levels; ++h) levels_.push_back(coarser(levels_.back(), 1 << (h - 1)));
}

namespace {

// The maximum of each element and the one `shift` before it, in rows of `row` elements; what there is only one of stays. One
// shift longer than it was.
std::vector<std::uint8_t> joined(const std::vector<std::uint8_t>& from, std::size_t row, std::size_t shift, std::uint8_t outside) {
  const std::size_t rows = from.size() / row, wide = row + shift, both = std::min(row, shift);
  std::vector<std::uint8_t> out(rows * wide, outside);
  for (std::size_t y = 0; y < rows; ++y) {
    const std::uint8_t* in = from.data() + y * row;
    std::uint8_t* to = out.data() + y * wide;
    std::copy_n(in, both, to);
    std::transform(in + both, in + row, in, to + both, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
    std::copy_n(in + (row - both), both, to + std::max(row, shift));
  }
  return out;
}

}  // namespace

// A square of 2^h cells is made of four with half its side, `half`: joined along x first, then along y, where a row is all rows.
ScorePyramid::Level ScorePyramid::coarser(const Level& fine, int half) {
  Level out{fine.width + half, fine.height + half, fine.offset_x + half, fine.offset_y + half, {}};
  if (fine.cells.empty()) {
    out.cells.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), kOutside);
    return out;
  }
  const auto shift = static_cast<std::size_t>(half);
  const auto along_x = joined(fine.cells, static_cast<std::size_t>(fine.width), shift, kOutside);
  out.cells = joined(along_x, along_x.size(), shift * static_cast<std::size_t>(out.width), kOutside);
  return out;
}

int ScorePyramid::sum(int level, std::span<const Cell> cells, const Cell& shift) const {
  const Level& of_level = levels_[static_cast<std::size_t>(level)];
  int sum = 0;
  for (const Cell& cell : cells) sum += of_level.at(cell.x + shift.x, cell.y + shift.y);
  return sum;
}

std::array<int, 4> ScorePyramid::sumsAtCorners(int level, std::span<const Cell> cells, const Cell& shift, int side) const {
  const Level& of_level = levels_[static_cast<std::size_t>(level)];
  const auto up = static_cast<std::size_t>(side) * static_cast<std::size_t>(of_level.width), right = static_cast<std::size_t>(side);
  std::array<int, 4> sums{};
  for (const Cell& cell : cells) {
    const int x = cell.x + shift.x, y = cell.y + shift.y;
    if (of_level.holds(x, y) && of_level.holds(x + side, y + side)) {
      const std::uint8_t* corner = &of_level.cells[of_level.index(x, y)];
      sums[0] += corner[0];
      sums[1] += corner[up];
      sums[2] += corner[right];
      sums[3] += corner[up + right];
    } else {
      sums[0] += of_level.at(x, y);
      sums[1] += of_level.at(x, y + side);
      sums[2] += of_level.at(x + side, y);
      sums[3] += of_level.at(x + side, y + side);
    }
  }
  return sums;
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
