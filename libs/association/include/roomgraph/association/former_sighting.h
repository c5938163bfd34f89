// SPDX-License-Identifier: BSD-3-Clause
// What is known still of a sighting that was given up.
#pragma once

#include <string>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/box.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A sighting that others repeat and that was given up for them.
struct FormerSighting {
  double t = 0;
  FrameId frame;
  std::string class_name;  ///< that was measured
  Box2 box;                ///< px
  LandmarkId landmark;
  double probability = 1;          ///< of the decision
  double existence_log_ratio = 0;  ///< what it says of the landmark's existence
  double weight = 0;               ///< among the landmark's sightings (sightingWeight())
  Eigen::Vector3d place_in_robot = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace roomgraph
