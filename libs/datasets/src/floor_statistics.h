// SPDX-License-Identifier: BSD-3-Clause
// Sensor height and tilt above the floor, agreed over many depth images.
#pragma once

#include <optional>
#include <vector>

#include "point_grid.h"
#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// Where the depth images of one sensor see the floor. On a robot that drives on it this is always the same
/// place; a handheld camera sees it now here, now there, and gives no answer.
class FloorStatistics {
 public:
  void add(const PointGrid& grid, const Pose3& robot_from_sensor);
  std::optional<FloorSummary> report() const;
  /// When images that show the floor do not agree where it is: median deviations of height (m) and direction (rad).
  std::optional<FloorSpread> spread() const;

 private:
  struct Sighting {
    Eigen::Vector3d up;  ///< of the floor, in the sensor's frame
    double height_m = 0;
  };
  static Sighting middleOf(const std::vector<Sighting>& sightings);
  static FloorSpread spreadOf(const std::vector<Sighting>& sightings, const Sighting& middle);
  static std::optional<Sighting> agreed(const std::vector<Sighting>& sightings);
  bool enough(const std::vector<Sighting>& sightings) const;
  std::vector<Sighting> by_pose_,
      by_image_;  ///< floor sought where the pose, and where the image has its down
  std::optional<Pose3> robot_from_sensor_;
  int images_ = 0;
};

}  // namespace roomgraph
