// SPDX-License-Identifier: BSD-3-Clause
// Insertion of scans with Bresenham rays, growth, and Catmull-Rom interpolation.
#include "probability_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <unordered_map>

namespace roomgraph {
namespace {

constexpr double kGrowthMargin = 2.0;  // m, so that a grid does not grow with every scan
constexpr std::size_t kMostValues = 1u << 16;
constexpr double kFarthestCell = 1e9;  // numbers of cells must fit an int, with room for the neighbours

/// Catmull-Rom weights of the four neighbours at t in [0, 1), and their derivatives by t.
void catmullRom(double t, double weights[4], double slopes[4]) {
  const double t2 = t * t, t3 = t2 * t;
  weights[0] = 0.5 * (-t + 2 * t2 - t3);
  weights[1] = 0.5 * (2 - 5 * t2 + 3 * t3);
  weights[2] = 0.5 * (t + 4 * t2 - 3 * t3);
  weights[3] = 0.5 * (-t2 + t3);
  slopes[0] = 0.5 * (-1 + 4 * t - 3 * t2);
  slopes[1] = 0.5 * (-10 * t + 9 * t2);
  slopes[2] = 0.5 * (1 + 8 * t - 9 * t2);
  slopes[3] = 0.5 * (-2 * t + 3 * t2);
}

float oddsOf(double probability) {
  return static_cast<float>(probability / (1 - probability));
}

}  // namespace

Eigen::Vector2i ProbabilityGrid::cellOf(const Eigen::Vector2d& point) const {
  const auto number = [this](double along) {
    const double cell = std::floor(along / cell_m_);
    return static_cast<int>(std::abs(cell) < kFarthestCell ? cell : -kFarthestCell);
  };
  return {number(point.x() - corner_.x()), number(point.y() - corner_.y())};
}

void ProbabilityGrid::growToContain(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const Eigen::Vector2i first = cellOf(low), last = cellOf(high);
  if (width_ > 0 && stored_.holds(first.x(), first.y()) && stored_.holds(last.x(), last.y())) return;
  const int margin = static_cast<int>(kGrowthMargin / cell_m_);
  const bool empty = width_ == 0;
  const int x0 = empty ? first.x() - margin : std::min(0, first.x() - margin);
  const int y0 = empty ? first.y() - margin : std::min(0, first.y() - margin);
  const int x1 = empty ? last.x() + margin : std::max(width_ - 1, last.x() + margin);
  const int y1 = empty ? last.y() + margin : std::max(height_ - 1, last.y() + margin);
  const int old_width = width_, old_height = height_;
  const std::vector<float> old_cells = std::move(cells_);
  width_ = x1 - x0 + 1;
  height_ = y1 - y0 + 1;
  stored_ = {0, 0, width_, height_};
  corner_ += cell_m_ * Eigen::Vector2d(x0, y0);
  cells_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.f);
  touched_.assign(cells_.size(), 0);
  for (int y = 0; y < old_height; ++y)
    std::copy_n(old_cells.begin() + static_cast<std::ptrdiff_t>(y) * old_width, old_width,
                cells_.begin() + static_cast<std::ptrdiff_t>(index(-x0, y - y0)));
}

void ProbabilityGrid::update(int ix, int iy, float odds_factor) {
  const std::size_t i = index(ix, iy);
  if (touched_[i] == insertion_) return;
  touched_[i] = insertion_;
  const float p = cells_[i] > 0 ? cells_[i] : 0.5f;
  const float odds = p / (1 - p) * odds_factor;
  cells_[i] = std::clamp(odds / (1 + odds), kMin, kMax);
}

// Bresenham's line, without its end cell.
void ProbabilityGrid::missAlong(Eigen::Vector2i from, const Eigen::Vector2i& to, float odds_factor) {
  const int dx = std::abs(to.x() - from.x()), dy = -std::abs(to.y() - from.y());
  const int step_x = from.x() < to.x() ? 1 : -1, step_y = from.y() < to.y() ? 1 : -1;
  for (int error = dx + dy; from != to;) {
    update(from.x(), from.y(), odds_factor);
    const int twice = 2 * error;
    if (twice >= dy) error += dy, from.x() += step_x;
    if (twice <= dx) error += dx, from.y() += step_y;
  }
}

void ProbabilityGrid::insert(const PlanarScan& scan, const Pose2& grid_from_robot, const GridUpdate& change) {
  const Points2 points = transformed(grid_from_robot, scan.points);
  const Eigen::Vector2d origin = grid_from_robot * scan.origin;
  Eigen::Vector2d low = origin, high = origin;
  for (const Eigen::Vector2d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  if (!low.allFinite() || !high.allFinite()) return;
  if (finished_) throw std::logic_error("a finished grid takes no scans");
  growToContain(low, high);
  if (++insertion_ == 0) {
    std::fill(touched_.begin(), touched_.end(), std::uint16_t{0});
    insertion_ = 1;
  }
  // Hits first: a cell that holds a surface is not cleared by another beam of the same scan that grazes it.
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2i cell = cellOf(p);
    update(cell.x(), cell.y(), oddsOf(change.hit_probability));
  }
  const Eigen::Vector2i start = cellOf(origin);
  for (const Eigen::Vector2d& p : points) missAlong(start, cellOf(p), oddsOf(change.miss_probability));
}

ProbabilityGrid::Block ProbabilityGrid::knownBlock() const {
  int x0 = width_, y0 = height_, x1 = -1, y1 = -1;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      if (known(x, y)) x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = y;
  return x1 < 0 ? Block{} : Block{x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

// Numbers of cells and the corner stay: points keep their places in cells to the last bit.
void ProbabilityGrid::finish() {
  const Block block = knownBlock();
  std::vector<float> cells;
  cells.reserve(static_cast<std::size_t>(block.width) * static_cast<std::size_t>(block.height));
  for (int y = block.y0; y < block.y0 + block.height; ++y) {
    const float* row = &cells_[index(block.x0, y)];
    cells.insert(cells.end(), row, row + block.width);
  }
  cells_ = std::move(cells);
  stored_ = block;
  finished_ = true;
  std::vector<std::uint16_t>().swap(touched_);
  encode();
}

// A grid holds some thousand different values: most cells were only missed, or are as free as can be.
void ProbabilityGrid::encode() {
  std::unordered_map<float, std::uint16_t> code_of;
  std::vector<float> values;
  std::vector<std::uint16_t> codes;
  codes.reserve(cells_.size());
  for (const float cell : cells_) {
    const auto [at, is_new] = code_of.emplace(cell, static_cast<std::uint16_t>(values.size()));
    if (is_new) values.push_back(cell);
    if (values.size() > kMostValues) return;
    codes.push_back(at->second);
  }
  values_ = std::move(values);
  codes_ = std::move(codes);
  std::vector<float>().swap(cells_);
}

std::vector<std::uint8_t> ProbabilityGrid::bytes() const {
  const auto byteOf = [](float cell) { return static_cast<std::uint8_t>(std::max(kMin, cell) * 255.f); };
  const std::vector<float>& numbers = values_.empty() ? cells_ : values_;
  std::vector<std::uint8_t> of_numbers(numbers.size());
  std::transform(numbers.begin(), numbers.end(), of_numbers.begin(), byteOf);
  if (values_.empty()) return of_numbers;
  std::vector<std::uint8_t> of_codes(codes_.size());
  std::transform(codes_.begin(), codes_.end(), of_codes.begin(), [&](std::uint16_t code) { return of_numbers[code]; });
  return of_codes;
}

double ProbabilityGrid::interpolate(const Eigen::Vector2d& point, Eigen::Vector2d* gradient) const {
  const double gx = (point.x() - corner_.x()) / cell_m_ - 0.5, gy = (point.y() - corner_.y()) / cell_m_ - 0.5;
  if (!(std::abs(gx) < kFarthestCell) || !(std::abs(gy) < kFarthestCell)) {
    if (gradient) gradient->setZero();
    return kMin;
  }
  const double fx = std::floor(gx), fy = std::floor(gy);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  double wx[4], wy[4], sx[4], sy[4];
  catmullRom(gx - fx, wx, sx);
  catmullRom(gy - fy, wy, sy);
  double value = 0, along_x = 0, along_y = 0;
  const bool interior = values_.empty() && stored_.holds(ix - 1, iy - 1) && stored_.holds(ix + 2, iy + 2);
  for (int j = 0; j < 4; ++j) {
    double row = 0, row_slope = 0;
    const float* cells = interior ? &cells_[index(ix - 1, iy - 1 + j)] : nullptr;
    for (int i = 0; i < 4; ++i) {
      const double p = interior ? std::max(kMin, cells[i]) : at(ix - 1 + i, iy - 1 + j);
      row += wx[i] * p;
      row_slope += sx[i] * p;
    }
    value += wy[j] * row;
    along_x += wy[j] * row_slope;
    along_y += sy[j] * row;
  }
  if (gradient) *gradient = Eigen::Vector2d(along_x, along_y) / cell_m_;
  return value;
}

}  // namespace roomgraph
