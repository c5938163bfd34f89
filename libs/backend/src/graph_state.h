// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <ceres/ceres.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// Storage behind FactorGraph. The maps are ordered, so residuals and blocks always come in the same order;
/// their nodes never move, so Ceres may keep pointers into them.
struct FactorGraph::Impl {
  struct Pose {
    std::array<double, 3> t;
    std::array<double, 4> q;  // x y z w
    bool fixed = false;
  };
  struct Object {
    std::array<double, 4> value;  // x y z yaw
    bool seen_yaw = false;
  };

  Impl();
  Pose& at(NodeId id);
  Object& at(LandmarkId id);

  std::map<NodeId, Pose> poses;
  std::map<LandmarkId, Object> objects;
  std::vector<BetweenFactor> between;
  std::vector<LandmarkFactor> sightings;
  std::unique_ptr<ceres::EigenQuaternionManifold> quaternion =
      std::make_unique<ceres::EigenQuaternionManifold>();
  std::unique_ptr<ceres::Problem> problem;
};

}  // namespace roomgraph
