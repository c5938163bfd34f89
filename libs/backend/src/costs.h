// SPDX-License-Identifier: BSD-3-Clause
// Cost functions of the factors. Their automatic derivatives take long to compile: two files of their own.
#pragma once

#include <ceres/cost_function.h>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

// New cost function of each factor; the caller owns it. Its parameter blocks: for a pose translation and quaternion
// (3 + 4), for a landmark (x, y, z, yaw) and, where its size matters, (width, depth, height), for a point its position
// in world. Factors that depend on a landmark's shape are given its kind.

ceres::CostFunction* costOf(const BetweenFactor& factor);
ceres::CostFunction* costOf(const PlanarFactor& factor);
ceres::CostFunction* costOf(const GroundFactor& factor);
ceres::CostFunction* costOf(const LandmarkFactor& factor);
ceres::CostFunction* costOf(const LandmarkViewFactor& factor);
ceres::CostFunction* costOf(const LandmarkGroundFactor& factor);

ceres::CostFunction* costOf(const LandmarkSizeFactor& factor);
ceres::CostFunction* costOf(const LandmarkBoxFactor& factor, ShapeKind kind);
ceres::CostFunction* costOf(const CameraPointFactor& factor);
ceres::CostFunction* costOf(const PointLandmarkFactor& factor, ShapeKind kind);
ceres::CostFunction* costOf(const LandmarkSideFactor& factor, ShapeKind kind);

/// Throws std::invalid_argument when the sizes of the prior's matrices do not fit each other.
ceres::CostFunction* costOf(const MarginalPrior& factor);

}  // namespace roomgraph
