// SPDX-License-Identifier: BSD-3-Clause
// Distance of surfaces in depth images from those in scans: a check of where the two sensors sit.
#pragma once

#include <optional>
#include <vector>

#include "point_grid.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// How far points of the depth images, about as high as the lidar, lie from the surfaces that it saw at
/// nearly the same time. In the order of the file.
class ScanAgreement {
 public:
  void addScan(const Scan& scan);
  void addImage(double t, const PointGrid& grid, const Pose3& robot_from_sensor);
  /// Median distance, m; nothing when the two saw too little together.
  std::optional<double> distance() const;

 private:
  struct SeenPoints {
    double t = 0;                         ///< s
    double height_m = 0;                  ///< of the lidar
    std::vector<Eigen::Vector3d> points;  ///< robot frame
  };
  void compare();

  std::optional<SeenPoints> scan_, image_;  ///< the latest
  std::vector<double> distances_;
};

}  // namespace roomgraph
