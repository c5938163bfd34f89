// SPDX-License-Identifier: BSD-3-Clause
// Insertion of beams into MRPT's log-odds grid, each cell once per scan.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Core>
#include <vector>

namespace roomgraph {

/// One beam in world, m.
struct Ray {
  Eigen::Vector2d end;
  bool hit = false;  ///< false: only the way to `end` is known (free)
};

/// Inserts beams into MRPT's log-odds grid. In MRPT's own insertion free space without a return has no limit per beam,
/// and neighbouring beams of a scan erase each other's returns on a wall seen at a grazing angle; here a scan changes a
/// cell once, and a return outweighs a passing beam.
class RayGrid {
 public:
  /// The grid must cover every ray.
  RayGrid(mrpt::maps::COccupancyGridMap2D& grid, double hit_probability, double pass_probability);
  void insert(const Eigen::Vector2d& origin, const std::vector<Ray>& rays);

 private:
  using Cell = mrpt::maps::COccupancyGridMap2D::cellType;
  std::size_t index(const Eigen::Vector2i& cell) const;
  Eigen::Vector2d toCells(const Eigen::Vector2d& world) const;
  void markHit(std::size_t index);
  void walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool hit);

  mrpt::maps::COccupancyGridMap2D& grid_;
  Cell hit_, pass_;                   ///< log-odds steps, both positive
  std::vector<std::uint32_t> stamp_;  ///< number of the last scan that changed the cell
  std::uint32_t scan_ = 0;
};

}  // namespace roomgraph
