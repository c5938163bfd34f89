// SPDX-License-Identifier: BSD-3-Clause
// How a camera on a robot is tilted against the floor that it sees.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/geometry/ground.h"

namespace roomgraph {

/// Collects where a camera on a robot that drives on a floor sees it. That is always the same place; one that changes, or that few images
/// show, says nothing.
class CameraTilt {
 public:
  /// Whether an image at time t (s) and place of the robot is to be looked at: once a second while it drives (.1 m, .1 rad), a hundred times
  /// in all.
  bool wants(double t, const Pose2& robot) const;
  /// The floor in it by the recorded pose of the camera, in the robot's frame; nothing where none was seen. One from which the camera would
  /// be more than 10 % and 5 cm nearer or farther than by its pose, or that is tilted by more than .4 rad, is none.
  void add(double t, const Pose2& robot, const std::optional<Plane>& in_robot, const Eigen::Vector3d& camera_in_robot);
  /// The floor's upward direction by that pose, in the robot's frame: (0, 0, 1) where it is right. Nothing before ten images, and three of
  /// five that were looked at, have shown it within .03 rad and 3 cm + 2 % of the median.
  std::optional<Eigen::Vector3d> up() const;

 private:
  struct Sighting {
    Eigen::Vector3d up;
    double height_m = 0;  ///< of the camera above it
  };
  std::optional<double> last_t_;
  Pose2 last_place_;
  int images_ = 0;
  std::vector<Sighting> seen_;
};

}  // namespace roomgraph
