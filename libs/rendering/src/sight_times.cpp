// SPDX-License-Identifier: BSD-3-Clause
// Rays over the grid from places along the path.
#include "sight_times.h"

#include <cmath>
#include <limits>

#include "roomgraph/maptools/grid_outlines.h"
#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {
namespace {

constexpr double kStation_m = 0.1;  ///< from one place of the path that rays start from to the next
constexpr double kNever = std::numeric_limits<double>::infinity();

std::vector<StampedPose> stations(const std::vector<StampedPose>& path) {
  std::vector<StampedPose> kept;
  for (const auto& stamped : path)
    if (kept.empty() || (stamped.pose.translation() - kept.back().pose.translation()).norm() >= kStation_m)
      kept.push_back(stamped);
  return kept;
}

class SightMap {
 public:
  SightMap(const mrpt::maps::COccupancyGridMap2D& grid, double range_m)
      : grid_(grid),
        width_(static_cast<int>(grid.getSizeX())),
        height_(static_cast<int>(grid.getSizeY())),
        cell_(static_cast<double>(grid.getResolution())),
        range_m_(range_m),
        times_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNever) {}

  void lookAround(const StampedPose& from) {
    // Neighbouring rays are a cell apart at their ends.
    const int rays = std::max(16, static_cast<int>(2 * M_PI * range_m_ / cell_));
    for (int i = 0; i < rays; ++i) look(from, 2 * M_PI * i / rays);
  }

  std::vector<double> finished(const std::vector<StampedPose>& places) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (double& time = at(x, y); time == kNever)
          time = isKnown(grid_.getCell(x, y)) ? nearest(places, x, y) : places.front().t;
    return std::move(times_);
  }

 private:
  double& at(int x, int y) {
    return times_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  }

  /// Up to and through the wall that it meets.
  void look(const StampedPose& from, double angle) {
    const Eigen::Vector2d start = from.pose.translation().head<2>();
    const Eigen::Vector2d step = 0.5 * cell_ * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d low(static_cast<double>(grid_.getXMin()), static_cast<double>(grid_.getYMin()));
    bool in_wall = false;
    for (int k = 0; k * 0.5 * cell_ <= range_m_; ++k) {
      const Eigen::Vector2d cell = (start + k * step - low) / cell_;
      const int x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
      if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
      const bool occupied = isOccupiedCell(grid_.getCell(x, y));
      if (in_wall && !occupied) return;
      in_wall = occupied;
      at(x, y) = std::min(at(x, y), from.t);
    }
  }

  double nearest(const std::vector<StampedPose>& places, int x, int y) const {
    const Eigen::Vector2d centre(static_cast<double>(grid_.getXMin()) + (x + 0.5) * cell_,
                                 static_cast<double>(grid_.getYMin()) + (y + 0.5) * cell_);
    double best = kNever, time = places.front().t;
    for (const auto& place : places) {
      const double squared = (place.pose.translation().head<2>() - centre).squaredNorm();
      if (squared < best) best = squared, time = place.t;
    }
    return time;
  }

  const mrpt::maps::COccupancyGridMap2D& grid_;
  int width_, height_;
  double cell_, range_m_;
  std::vector<double> times_;
};

}  // namespace

std::vector<double> sightTimes(const CSemanticMap& map, double range_m) {
  if (!map.occupancy || map.world_from_robot.empty()) return {};
  const auto places = stations(map.world_from_robot);
  SightMap sight(*map.occupancy, range_m);
  for (const auto& place : places) sight.lookAround(place);
  return sight.finished(places);
}

}  // namespace roomgraph
