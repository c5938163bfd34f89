// SPDX-License-Identifier: BSD-3-Clause
// Construction of the factor graph, whole or as a sliding window, from all measurements of a run.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_factors.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// What was measured of the poses themselves, beside the sources of motion.
struct Measurements {
  std::vector<RelativePose> closures;  ///< between robots at two times
  std::vector<GroundFactor> grounds;   ///< handheld camera only
  bool planar = true;                 ///< a robot on the floor
};

/// Whether any source of motion saw the movement from the time of one key pose to that of the other.
bool connected(const Motion& motion, const KeyPose& a, const KeyPose& b);

/// Edges of all sources of motion between consecutive key poses, priors, closures, ground and objects
/// (method.md sec. 4.4, factors 1 to 6).
FactorGraph buildGraph(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                       const ObjectsInGraph& objects, const BackendOptions& options);

/// The latest key poses, and the older ones that closures reach back to.
struct Window {
  FactorGraph graph;
  std::vector<NodeId> held;
};

/// The key poses from `first` on. `prior` is what was measured before says of them; without one the first is
/// held. Poses before it, to which closures reach back, are held. Landmarks are left out: with their
/// sightings in the window, with 1 % or 20 % of their information, the live pose was no
/// better.
Window buildWindow(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                   const BackendOptions& options, std::size_t first,
                   const std::optional<MarginalPrior>& prior);

}  // namespace roomgraph
