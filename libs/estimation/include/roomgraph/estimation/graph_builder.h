// SPDX-License-Identifier: BSD-3-Clause
// Construction of the factor graph, whole or as a sliding window, from all measurements of a run.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_factors.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// Where in world the robot is, as an earlier map whose frame world is tells it.
struct MapFix {
  double t = 0;
  Pose3 world_from_robot = Pose3::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of (translation, rotation), in world
};

/// Measurements of the poses other than by the sources of motion.
struct Measurements {
  GrowingList<RelativePose> closures;  ///< between robots at two times
  std::vector<GroundFactor> grounds;   ///< handheld camera only
  bool planar = true;                  ///< a robot on the floor
  std::vector<MapFix> fixes;           ///< with any, world is held by them and not by the first key pose
  std::vector<RelativePose> pulls;     ///< closures that hold without a robust loss, too
  GrowingList<std::size_t> closures_before = {};  ///< by key pose: how many closures there were when it was added
};

/// Whether any source of motion covers the time from one key pose to the other.
bool connected(const Motion& motion, const KeyPose& a, const KeyPose& b);

/// A closure between two times as a factor between the key poses nearest to them; nothing when that is one key
/// pose. What a planar closure did not measure has a variance of 0.25. There must be a key pose.
std::optional<BetweenFactor> closureFactor(const RelativePose& closure, const KeyPoses& poses, double robust_width);

/// What a source of motion matched against one local map: consecutive key poses, [first, end) of all. The
/// map's own pose is that of the robot at the first one, as the source saw it.
struct LocalMap {
  NodeId id;
  std::size_t first = 0, end = 0;
  bool follows = false;  ///< the source also covers the movement from the beginning of the map before it
};

constexpr std::size_t kAllFree = std::numeric_limits<std::size_t>::max();

/// Whether so many key poses move in bodies even where all are free: more than 2000.
bool alwaysInBodies(std::size_t key_poses);

/// Movements between consecutive key poses, local maps of images and scans with the key poses in them,
/// priors, closures, ground and objects (method.md sec. 4.4, factors 1 to 6). With a `former` graph of the
/// run, local maps, views and points begin where its solution left them. Only the latest `free` key poses have poses of their
/// own; older ones move rigidly with the first one of their body: of ten, of twenty where a thousand came after, of forty where
/// two thousand came, and so on. So do all that are free where there are too many (alwaysInBodies()).
FactorGraph buildGraph(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                       const ObjectsInGraph& objects, const BackendOptions& options,
                       const FactorGraph* former = nullptr, std::size_t free = kAllFree);
/// Those of the landmarks that the graph holds.
std::vector<LandmarkId> landmarksIn(const FactorGraph& graph, const ObjectsInGraph& objects);

/// By key pose that has left the window: how many closures there were then. Those that connect it with later ones are in the prior.
using ClosuresInPrior = std::map<NodeId, std::size_t>;

/// Graph of the latest key poses and of the older ones that closures connect them with.
struct Window {
  FactorGraph graph;
  std::vector<NodeId> held;
  std::vector<LocalMap> local_maps;
};

/// The key poses from `first` on, with the marginal prior of earlier measurements; without one the first is
/// held. Earlier poses in closures are held. Landmarks are left out: with their sightings in the window, with
/// 1 % or 20 % of their information, the live pose was no better.
Window buildWindow(const KeyPoses& poses, const Motion& motion, const Measurements& measurements,
                   const BackendOptions& options, std::size_t first,
                   const std::optional<MarginalPrior>& prior, const ClosuresInPrior& in_prior = {});

}  // namespace roomgraph
