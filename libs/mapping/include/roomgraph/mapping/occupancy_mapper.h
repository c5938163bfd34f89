// SPDX-License-Identifier: BSD-3-Clause
// Occupancy mapping from posed lidar scans or depth images.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <optional>
#include <utility>
#include <vector>

#include "roomgraph/mapping/occupancy_options.h"
#include "roomgraph/observations/repeated_views.h"

namespace roomgraph {

/// Occupancy grid from posed scans, or, where and when there is no lidar, from posed depth images (a virtual scan over
/// a band of heights above the ground).
class OccupancyMapper {
 public:
  explicit OccupancyMapper(const OccupancyOptions& options = {}) : options_(options) {}
  /// Stores the scan, so that the grid can be built again with other poses.
  void add(const Scan& scan);
  /// `ground`: floor in the camera frame. `moving`: boxes (px) of what moves by itself, which is not drawn. A
  /// frame without depth is left out.
  void add(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving = {});
  /// What add() of a frame stores, and such a slice.
  std::optional<RangeFan> slice(const Frame& frame, const Plane& ground, const std::vector<Box2>& moving = {}) const;
  void add(RangeFan slice) { slices_.push_back(std::move(slice)); }
  /// Whether the grid would be drawn from depth images of this time, as far as is known: with `auto`, where no scan
  /// is near in time.
  bool drawsDepth(double t) const;
  /// Gives up scans and images that repeat others from that place in that direction, when there are more than `kept` of a kind.
  void giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot);
  /// Grid in world from all kept scans, posed by the trajectory (scans without a pose are left out); null
  /// without any. Cells hold the probability of being free (MRPT). Throws RunError when the grid would be too
  /// large to be right (a wrong trajectory). With an `earlier` grid, in world too, the result is that grid,
  /// as large as needed, with the scans' log odds added to its own; its cells stay where they are.
  mrpt::maps::COccupancyGridMap2D::Ptr build(const Trajectory& world_from_robot,
                                             const mrpt::maps::COccupancyGridMap2D* earlier = nullptr) const;

 private:
  struct PosedFan;
  void select(const std::vector<RangeFan>& fans, const Trajectory& world_from_robot,
              std::vector<PosedFan>& out) const;
  bool isFarFromScans(double t) const;

  OccupancyOptions options_;
  std::vector<RangeFan> scans_, slices_;
  std::vector<std::pair<double, double>> scanned_;  ///< spans of time with scans, s
  GrowthWatch scans_watch_, slices_watch_;
};

}  // namespace roomgraph
