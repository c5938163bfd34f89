// SPDX-License-Identifier: BSD-3-Clause
// Overlapping submaps under construction, and the motion filter for scans.
#pragma once

#include <memory>
#include <vector>

#include "probability_grid.h"
#include "surface_cells.h"

namespace roomgraph {

/// Motion filter: keeps a scan when translation, rotation or time since the last one kept reaches its
/// threshold.
struct MotionFilter {
  double distance_m = 0.2, angle_rad = 0.17, time_s = 5;
  bool moved(double t_last, const Pose2& last, double t, const Pose2& pose) const;
};

/// A local map of a run of successive scans.
struct Submap {
  explicit Submap(double cell_m) : grid(cell_m), surfaces(cell_m) {}
  ProbabilityGrid grid;     ///< in the matcher's frame
  LocalSurfaces surfaces;   ///< in the same frame
  int first_insertion = 0;  ///< running number of its first scan among all inserted
  int insertions = 0;
  bool finished = false;

  /// Of a finished one that is to be kept: gives back what only insertion needs.
  void pack();
};

/// Two submaps in the making that overlap by half: each scan goes into both, the older one is matched against
/// and is finished when it is full (Hess et al. 2016, sec. IV-C).
class ActiveSubmaps {
 public:
  ActiveSubmaps(double cell_m, int scans_per_submap, const GridUpdate& update)
      : cell_m_(cell_m), scans_per_submap_(scans_per_submap), update_(update) {}

  /// Returns the submap this insertion finished, or nothing.
  std::shared_ptr<Submap> insert(const PlanarScan& scan, const Pose2& odom_from_robot);
  /// The older one; null before the first insertion.
  const Submap* oldest() const { return active_.empty() ? nullptr : active_.front().get(); }
  /// Ends the ones in the making, which share no scan with what follows; returns the older one when it holds
  /// enough.
  std::shared_ptr<Submap> finishAll();

 private:
  double cell_m_;
  int scans_per_submap_;
  GridUpdate update_;
  int inserted_ = 0;
  std::vector<std::shared_ptr<Submap>> active_;
};

}  // namespace roomgraph
