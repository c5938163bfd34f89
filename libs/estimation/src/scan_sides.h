// SPDX-License-Identifier: BSD-3-Clause
// Returns of scans that end on the upright sides of landmarks, as factors of the graph.
#pragma once

#include <vector>

#include "roomgraph/backend/factors.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/object_database.h"
#include "space_memory.h"

namespace roomgraph {

/// What scans say about where the landmarks' sides are (method.md sec. 4.4, factor 4). Of a cuboid, returns
/// near a side that faces the lidar, where its class is solid at the lidar's height; of a door, returns on
/// the wall beside it, whose face is the door's; of a cylinder, returns within reach of it: legs and columns
/// stand inside, what goes on beyond it is a wall or a desk. A side of which a scan shows less than a few
/// returns, or returns that do not lie on a line, gives nothing. Returns from one direction repeat their
/// errors, as sightings do, and weigh as much as their mean.
std::vector<LandmarkSideFactor> scanSides(const KeptScans& scans, const KeyPoses& poses,
                                          const std::vector<Landmark>& landmarks,
                                          const ObjectDatabase& database, const BackendOptions& options);

}  // namespace roomgraph
