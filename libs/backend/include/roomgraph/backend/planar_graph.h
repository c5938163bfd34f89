// SPDX-License-Identifier: BSD-3-Clause
// 2D pose graph with landmarks in g2o's convention: chi-squared, initialisation, optimisation.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// Movement between two poses in the plane.
struct PlanarEdge {
  NodeId a, b;
  Pose2 a_from_b;
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Identity();  ///< of (x, y, yaw), in the measurement's b frame
};

/// A vertex that is an object: its bottom centre, and the yaw of its front.
struct PlanarLandmark {
  LandmarkId id;
  ObjectShape shape;
};

/// Pose graph in the plane, as in 2D g2o files. Its error is that of g2o's EDGE_SE2, in which the optima of the public
/// data sets are published: e = (x, y, yaw) of a_from_b(measured)^-1
/// a_from_b(estimated), yaw wrapped; chi^2 = sum e' information e.
struct PlanarGraph {
  std::map<NodeId, Pose2> poses;  ///< world_from_robot; of landmarks, too
  std::map<NodeId, PlanarLandmark> landmarks;
  std::set<NodeId> fixed;
  std::vector<PlanarEdge> edges;
};

double chiSquared(const PlanarGraph& graph);
/// Initialises the poses from the edges alone by chordal relaxation; kept when they lower chi^2. Returns whether
/// anything changed.
bool initializePoses(PlanarGraph& graph);
/// Least squares over every pose that is not fixed. Throws std::out_of_range for an edge between unknown
/// poses.
SolveReport optimize(PlanarGraph& graph, const SolveOptions& options = {});

}  // namespace roomgraph
