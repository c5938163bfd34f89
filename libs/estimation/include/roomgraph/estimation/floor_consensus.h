// SPDX-License-Identifier: BSD-3-Clause
// Agreement of several frames about where the floor is, for a camera that nothing holds at a known height.
#pragma once

#include <deque>
#include <optional>

#include "roomgraph/geometry/ground.h"

namespace roomgraph {

/// Planes that may be the floor, of a handheld camera. One frame may see a table top only; what several
/// frames of some time agree on is believed, unless others saw a plane below it. A plane unusually near to
/// the camera must last longer.
class FloorConsensus {
 public:
  /// A plane seen at time t, in world (m; normal towards the camera), and where the camera was. Planes of the
  /// last seconds are kept, so that world may drift, but must not be moved: `clear` then. Returns the floor
  /// in world as soon as it is certain.
  std::optional<Plane> add(double t, const Plane& in_world, const Eigen::Vector3d& camera_in_world);
  void clear() { sightings_.clear(); }

 private:
  struct Sighting {
    double t = 0;
    Plane plane;
  };
  std::deque<Sighting> sightings_;
};

/// Whether z = 0, a supposed floor of world, cannot be the floor if this plane is: it lies clearly below, or
/// is tilted against it at about the same height. A table top contradicts no floor.
bool contradictsFloor(const Plane& in_world, const Eigen::Vector3d& camera_in_world);

}  // namespace roomgraph
