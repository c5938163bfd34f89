// SPDX-License-Identifier: BSD-3-Clause
// Whether a camera is on a robot.
#pragma once

#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// A sensor on a robot has a place on it, above its origin; a handheld camera has none.
inline bool isMounted(const Pose3& robot_from_camera) {
  return robot_from_camera.translation().z() > 0.1;
}
inline bool isMounted(const Frame& frame) {
  return isMounted(frame.robot_from_camera);
}

}  // namespace roomgraph
