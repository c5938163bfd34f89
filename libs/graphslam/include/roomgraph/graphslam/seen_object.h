// SPDX-License-Identifier: BSD-3-Clause
// Objects as they were seen from the nodes of a pose network.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "roomgraph/core/ids.h"
#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// A landmark and where it was seen from a node.
struct SeenObject {
  LandmarkId landmark;
  std::string class_name;
  Pose3 node_from_object = Pose3::Identity();          ///< origin: bottom centre, x: front
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< width, depth, height
  double sigma_m = 0.05;                               ///< of the place, in the direction that is known least
  int symmetry = 1;                                    ///< turns that look alike; 0: the front is not known
};

/// "chair 3 (1.20 0.40 0.00), sofa 1 (...)": class, landmark, place; empty without objects.
std::string describe(const std::vector<SeenObject>& objects);

/// A landmark where the nodes that see it place it: the mean of the sightings by their information, those weighed down
/// that contradict it (Cauchy).
struct PlacedObject {
  std::string class_name;  ///< that of most sightings
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< bottom centre in world, m
  double yaw = 0;                                      ///< of the front, rad: the mean direction, or one that looks alike
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  int nodes = 0;         ///< that see it
  bool has_yaw = false;  ///< false: no sighting tells the front
};

/// The objects of a network: pairs of world_from_node and what was seen there.
std::map<LandmarkId, PlacedObject> placeObjects(
    const std::vector<std::pair<Pose3, std::vector<SeenObject>>>& nodes);

}  // namespace roomgraph
