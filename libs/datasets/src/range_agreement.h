// SPDX-License-Identifier: BSD-3-Clause
// Ratio of depth-camera ranges to lidar ranges: a check of the depth unit.
#pragma once

#include <optional>
#include <vector>

#include "point_grid.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// How far the depth images see things, over how far the lidar does, along horizontal rays. The two look at
/// different heights, so only the middle of many ratios says something.
class RangeAgreement {
 public:
  void addScan(const Scan& scan) { scan_ = scan; }
  void addImage(double t, const PointGrid& grid, const Pose3& robot_from_sensor);
  /// Median ratio; nothing when the two saw too little together.
  std::optional<double> ratio() const;

 private:
  std::optional<Scan> scan_;  ///< the latest
  std::vector<double> ratios_;
};

}  // namespace roomgraph
