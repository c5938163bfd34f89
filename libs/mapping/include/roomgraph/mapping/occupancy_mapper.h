// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/geometry/ground.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/scan.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Occupancy grid from posed scans, or, where there is no lidar, from posed depth images (a virtual scan over a band
/// of heights above the ground).
class OccupancyMapper : public Configurable {
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  /// Keeps what is needed to (re)build the grid later with other poses.
  void add(const Scan& scan);
  /// `ground`: floor in the camera frame.
  void add(const Frame& frame, const Plane& ground);
  /// Grid in world from all kept scans, posed by the trajectory (scans without a pose are left out); null when
  /// nothing was kept.
  mrpt::maps::COccupancyGridMap2D::Ptr build(const Trajectory& world_from_robot) const;

 private:
  double resolution_m_ = 0.05;
};

}  // namespace roomgraph
