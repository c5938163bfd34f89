// SPDX-License-Identifier: BSD-3-Clause
// Sums per cell and facing, and the principal axes of those around a point.
#include "surface_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {
namespace {

constexpr double kFewestReturns = 6, kFewestNeighbours = 3;
constexpr double kLongestAcross = 0.15;  // variance across over variance along: more is no line
constexpr int kReach = 6;                // neighbours on either side of a return, in the order of the beams
constexpr double kNear_m = 0.15, kNearPerRange = 0.06;  // farther returns are no neighbours

/// Sums over points, from some origin.
struct Scatter {
  double count = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();  // xx, xy, yy
  void add(const Eigen::Vector2d& p) {
    count += 1;
    first += p;
    second += Eigen::Vector3d(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
  }
};

std::optional<SurfaceLine> lineThrough(const Scatter& sums, double fewest) {
  if (sums.count < fewest) return std::nullopt;
  const Eigen::Vector2d mean = sums.first / sums.count;
  const Eigen::Vector3d square = sums.second / sums.count;
  const double xx = square[0] - mean.x() * mean.x(), xy = square[1] - mean.x() * mean.y(), yy = square[2] - mean.y() * mean.y();
  const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
  const double across = std::max(0.0, middle - spread), along = middle + spread;
  if (!(across < kLongestAcross * along)) return std::nullopt;
  const double direction = 0.5 * std::atan2(2 * xy, xx - yy);
  // Two of the returns' freedoms are the line's own: their variance across is that much larger than it looks.
  const double turn_rad2 = along > 0 ? across / (std::max(1.0, static_cast<double>(sums.count) - 2) * along) : 0;
  return SurfaceLine{mean, {-std::sin(direction), std::cos(direction)}, across, turn_rad2};
}

}  // namespace

// Numbers of cells must fit 32 bits.
bool SurfaceCells::isReachable(const Eigen::Vector2d& point) {
  constexpr double kFarthest_m = 1e6;
  return std::abs(point.x()) < kFarthest_m && std::abs(point.y()) < kFarthest_m;  // false for what is not finite
}

int SurfaceCells::sectorOf(double facing_rad) {
  const double turns = wrapAngle(facing_rad) / (2 * std::numbers::pi) + 0.5;
  return static_cast<int>(turns * kSectors) % kSectors;
}

void SurfaceCells::finish() {
  if (finished_) return;
  finished_ = true;
  for (const auto& [cell, first] : first_of_cell_) cells_.push_back(cell);
  cells_.shrink_to_fit();
  std::sort(cells_.begin(), cells_.end());
  firsts_.reserve(cells_.size());
  for (const std::uint64_t cell : cells_) firsts_.push_back(first_of_cell_.at(cell));
  std::unordered_map<std::uint64_t, std::int32_t>().swap(first_of_cell_);
  facings_.shrink_to_fit();
}

std::int32_t SurfaceCells::firstOf(std::uint64_t cell) const {
  if (!finished_) {
    const auto found = first_of_cell_.find(cell);
    return found == first_of_cell_.end() ? kNone : found->second;
  }
  const auto found = std::lower_bound(cells_.begin(), cells_.end(), cell);
  return found == cells_.end() || *found != cell ? kNone : firsts_[static_cast<std::size_t>(found - cells_.begin())];
}

SurfaceCells::Sums& SurfaceCells::sumsOf(std::uint64_t cell, int sector) {
  const auto [at, is_new] = first_of_cell_.emplace(cell, kNone);
  for (std::int32_t i = at->second; i != kNone; i = facings_[static_cast<std::size_t>(i)].next)
    if (facings_[static_cast<std::size_t>(i)].sector == sector) return facings_[static_cast<std::size_t>(i)].sums;
  facings_.push_back({{}, sector, at->second});
  at->second = static_cast<std::int32_t>(facings_.size()) - 1;
  return facings_.back().sums;
}

void SurfaceCells::insert(const FacedScan& scan) {
  if (finished_) throw std::logic_error("finished surfaces take no scans");
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector2d& p = scan.points[i];
    if (!isReachable(p)) continue;
    const double cx = std::floor(p.x() / cell_m_), cy = std::floor(p.y() / cell_m_);
    Sums& sums = sumsOf(key(static_cast<std::int32_t>(cx), static_cast<std::int32_t>(cy)), sectorOf(scan.facing_rad[i]));
    const Eigen::Vector2f offset = (p - cell_m_ * Eigen::Vector2d(cx, cy)).cast<float>();
    sums.count += 1;
    sums.first += offset;
    sums.second += Eigen::Vector3f(offset.x() * offset.x(), offset.x() * offset.y(), offset.y() * offset.y());
  }
}

SurfaceCells::Place SurfaceCells::placeOf(const Eigen::Vector2d& point, int sector) const {
  return {static_cast<std::int32_t>(std::floor(point.x() / cell_m_)), static_cast<std::int32_t>(std::floor(point.y() / cell_m_)), sector};
}

std::optional<SurfaceLine> SurfaceCells::around(const Eigen::Vector2d& point, double facing_rad) const {
  if (!isReachable(point)) return std::nullopt;
  return lineAt(placeOf(point, sectorOf(facing_rad)));
}

std::optional<SurfaceLine> SurfaceCells::lineAt(const Place& place) const {
  Scatter sum;  // from the corner of the cell in the middle
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Eigen::Vector2d shift = cell_m_ * Eigen::Vector2d(dx, dy);
      for (std::int32_t i = firstOf(key(place.x + dx, place.y + dy)); i != kNone; i = facings_[static_cast<std::size_t>(i)].next) {
        const Facing& facing = facings_[static_cast<std::size_t>(i)];
        const int apart = std::abs(facing.sector - place.sector);
        if (std::min(apart, kSectors - apart) > 1) continue;
        const Eigen::Vector2d first = facing.sums.first.cast<double>();
        const double n = static_cast<double>(facing.sums.count);
        sum.count += n;
        sum.first += first + n * shift;
        sum.second += facing.sums.second.cast<double>() +
                      Eigen::Vector3d(2 * shift.x() * first.x() + n * shift.x() * shift.x(),
                                      shift.x() * first.y() + shift.y() * first.x() + n * shift.x() * shift.y(),
                                      2 * shift.y() * first.y() + n * shift.y() * shift.y());
      }
    }
  auto line = lineThrough(sum, kFewestReturns);
  if (line) line->mean += cell_m_ * Eigen::Vector2d(place.x, place.y);
  return line;
}

void LocalSurfaces::insert(const FacedScan& scan) {
  for (SurfaceCells& level : levels_) level.insert(scan);
}

void LocalSurfaces::finish() {
  for (SurfaceCells& level : levels_) level.finish();
}

std::optional<SurfaceLine> LocalSurfaces::around(const Eigen::Vector2d& point, double facing_rad, int levels) const {
  for (int i = 0; i < levels; ++i)
    if (const auto line = levels_[static_cast<std::size_t>(i)].around(point, facing_rad)) return line;
  return std::nullopt;
}

const SurfaceLine* LinesOfReturns::around(std::size_t number, const Eigen::Vector2d& point, double facing_rad, int levels) {
  if (!SurfaceCells::isReachable(point)) return nullptr;
  const int sector = SurfaceCells::sectorOf(facing_rad);
  for (int i = 0; i < levels; ++i) {
    const SurfaceCells& level = surfaces_.level(i);
    const SurfaceCells::Place place = level.placeOf(point, sector);
    Found& found = found_[number][static_cast<std::size_t>(i)];
    if (found.place != place) found = {place, level.lineAt(place)};
    if (found.line) return &*found.line;
  }
  return nullptr;
}

FacedScan faced(const PlanarScan& scan) {
  FacedScan out{scan.points, {}};
  const int size = static_cast<int>(scan.points.size());
  for (int i = 0; i < size; ++i) {
    const Eigen::Vector2d& p = scan.points[static_cast<std::size_t>(i)];
    const Eigen::Vector2d to_lidar = scan.origin - p;
    const double radius = std::max(kNear_m, kNearPerRange * to_lidar.norm());
    Scatter neighbours;
    for (int j = std::max(0, i - kReach); j < std::min(size, i + kReach + 1); ++j) {
      const Eigen::Vector2d offset = scan.points[static_cast<std::size_t>(j)] - p;
      if (offset.squaredNorm() <= radius * radius) neighbours.add(offset);
    }
    const auto line = lineThrough(neighbours, kFewestNeighbours);
    Eigen::Vector2d normal = line ? line->normal : to_lidar;
    if (normal.dot(to_lidar) < 0) normal = -normal;
    out.facing_rad.push_back(std::atan2(normal.y(), normal.x()));
  }
  return out;
}

FacedScan transformed(const Pose2& a_from_b, const FacedScan& in_b) {
  FacedScan out{transformed(a_from_b, in_b.points), in_b.facing_rad};
  for (double& facing : out.facing_rad) facing += a_from_b.yaw;
  return out;
}

}  // namespace roomgraph
