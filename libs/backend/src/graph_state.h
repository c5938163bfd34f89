// SPDX-License-Identifier: BSD-3-Clause
// State behind FactorGraph: parameter blocks by id, factors, and linearisation along tangents.
#pragma once

#include <ceres/manifold.h>
#include <ceres/problem.h>

#include <Eigen/SparseCore>
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "attached_poses.h"
#include "movement_sum.h"
#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// Residuals with their derivatives along the tangents of some blocks.
struct Linearization {
  Eigen::SparseMatrix<double> jacobian;
  Eigen::VectorXd residuals;
};

/// Storage of FactorGraph. The maps are ordered, so residuals and blocks always have the same order; their nodes do not
/// move in memory, so Ceres may keep pointers into them.
struct FactorGraph::Impl {
  struct Pose {
    std::array<double, 3> t;
    std::array<double, 4> q;  // x y z w
    bool fixed = false;
    void start(const Pose& from) { t = from.t, q = from.q; }
  };
  struct Object {
    std::array<double, 4> value;  // x y z yaw
    std::array<double, 3> size;   // width, depth, height
    ShapeKind kind;
    bool free_yaw = false, free_size = false;
    void start(const Object& from) { value = from.value, size = from.size; }
  };
  struct Point {
    std::array<double, 3> value;
    void start(const Point& from) { value = from.value; }
  };
  struct Entry {
    Factor factor;
    ceres::ResidualBlockId block;
  };

  /// In a g2o file the numbers of landmarks follow those of the poses.
  NodeId vertexOf(LandmarkId id) const {
    return NodeId{(poses.empty() ? 0 : poses.rbegin()->first.value + 1) + id.value};
  }

  Impl();
  Pose& at(NodeId id);
  Object& at(LandmarkId id);
  Point& at(PointId id);
  void freeYaw(LandmarkId id);
  void freeSize(LandmarkId id);

  /// With robust losses and weights applied; columns in the order of `blocks`, all of which must be variable.
  /// Nothing when a residual or derivative is not finite.
  std::optional<Linearization> linearize(const std::vector<double*>& blocks,
                                         const std::vector<ceres::ResidualBlockId>& residual_blocks) const;
  /// Everything that is not held, in the order of the maps.
  std::vector<double*> variableBlocks();
  int freedoms(const double* block) const { return problem->ParameterBlockTangentSize(block); }

  std::map<NodeId, Pose> poses;
  AttachedPoses attached;
  std::set<NodeId> bodies;  ///< poses that others are attached to
  std::map<std::pair<NodeId, NodeId>, MovementSum> sums;
  std::map<LandmarkId, Object> objects;
  std::map<PointId, Point> points;
  std::deque<Entry> factors;  ///< tens of thousands, of half a kilobyte each: none is moved or held in reserve
  ceres::EigenQuaternionManifold quaternion;
  ceres::SubsetManifold held_yaw{4, {3}};  // a yaw that nothing measures would make the problem singular
  std::unique_ptr<ceres::Problem> problem;
};

}  // namespace roomgraph
