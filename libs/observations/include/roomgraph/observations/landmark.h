// SPDX-License-Identifier: BSD-3-Clause
// Landmark: an object of the semantic map with pose, covariance, existence and class posterior.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/shape.h"

namespace roomgraph {

/// One object of the semantic map (method.md sec. 6).
struct Landmark {
  LandmarkId id;
  std::string class_name, model;
  ObjectShape shape;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< bottom centre in world, m
  double yaw = 0;                                      ///< direction of the front in world, rad
  bool has_yaw = false;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  ///< of (x, y, z, yaw)
  double existence = 0;                                      ///< probability in [0, 1]
  std::map<std::string, double> class_posterior;             ///< sums to 1
  int observations = 0;
  std::optional<double> stands_since;  ///< s; of one that was moved during the run: when it was first seen where it stands now

  Pose3 worldFromObject() const { return poseFromYpr(position.x(), position.y(), position.z(), yaw, 0, 0); }
};

}  // namespace roomgraph
