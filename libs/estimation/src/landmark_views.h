// SPDX-License-Identifier: BSD-3-Clause
// What was seen of a landmark, by the direction it was seen from and the end of it that was in view.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/estimation/object_factors.h"

namespace roomgraph {

/// A sighting from a key pose, the proposal that it is of (never null), and the weight of what that says about the size.
struct LandmarkSighting {
  LandmarkFactor factor;
  const Proposal* proposal;
  double size_weight;
};

using SightingsByNode = std::map<NodeId, std::vector<LandmarkSighting>>;

/// The direction from a key pose to a place (world), in steps of `angle_rad`.
int directionOf(const Eigen::Vector3d& place, const KeyPose& node, double angle_rad);

/// The sighting as it is where the landmark has the size of `shape`: what its proposal holds fast, the end that was seen,
/// stays where it is, and the middle's uncertainty is without that of the size. `sighting`: its place, yaw and covariance
/// in the level world. `usual`: model of the proposal's class.
LandmarkFactor atSize(const ObjectShape& shape, const LandmarkSighting& sighting, const ObjectModel& usual);

/// Adds the views of a landmark, its sizes and its yaw (see objectFactors()). `usual` (may be null): model of its class.
/// Returns whether there is a view that ties the landmark to the key poses.
bool addViews(const SightingsByNode& sightings, const Landmark& landmark, const ObjectModel* usual, const KeyPoses& poses,
              const BackendOptions& options, ObjectFactors& out);

}  // namespace roomgraph
