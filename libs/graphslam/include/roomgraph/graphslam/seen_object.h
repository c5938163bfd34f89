// SPDX-License-Identifier: BSD-3-Clause
// An object as it was seen from a node of a pose network.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roomgraph/core/ids.h"

namespace roomgraph {

/// A landmark and where it was seen from a node.
struct SeenObject {
  LandmarkId landmark;
  std::string class_name;
  Eigen::Vector3d in_robot = Eigen::Vector3d::Zero();  ///< bottom centre in the node's frame, m
};

/// "chair 3 (1.20 0.40 0.00), sofa 1 (…)": class, landmark, place; empty without objects.
std::string describe(const std::vector<SeenObject>& objects);

}  // namespace roomgraph
