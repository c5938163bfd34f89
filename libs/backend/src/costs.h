// SPDX-License-Identifier: BSD-3-Clause
// Ceres cost functions of the factors, with the sizes of their parameter blocks.
#pragma once

#include <ceres/ceres.h>

#include "marginal_prior_cost.h"
#include "object_residuals.h"
#include "residuals.h"

namespace roomgraph {

// The cost function of each factor, with the sizes of its blocks: poses are 3 + 4, landmarks 4 (+ 3 where
// their size matters), points 3. Those that depend on a landmark's shape are told its kind.

template <class Residual, int Count, int... Blocks, class... Arguments>
ceres::CostFunction* automatic(const Arguments&... arguments) {
  return new ceres::AutoDiffCostFunction<Residual, Count, Blocks...>(new Residual(arguments...));
}

inline ceres::CostFunction* costOf(const BetweenFactor& f) {
  return automatic<BetweenResidual, 6, 3, 4, 3, 4>(f);
}
inline ceres::CostFunction* costOf(const PlanarFactor& f) {
  return automatic<PlanarResidual, 3, 3, 4>(f);
}
inline ceres::CostFunction* costOf(const GroundFactor& f) {
  return automatic<GroundResidual, 3, 3, 4>(f);
}
inline ceres::CostFunction* costOf(const LandmarkFactor& f) {
  return automatic<LandmarkResidual, 4, 3, 4, 4>(f);
}
inline ceres::CostFunction* costOf(const LandmarkViewFactor& f) {
  return automatic<LandmarkViewResidual, 4, 4, 4>(f);
}
inline ceres::CostFunction* costOf(const LandmarkGroundFactor& f) {
  return automatic<LandmarkGroundResidual, 1, 4>(f);
}
inline ceres::CostFunction* costOf(const LandmarkSizeFactor& f) {
  return automatic<LandmarkSizeResidual, 3, 3>(f);
}
inline ceres::CostFunction* costOf(const LandmarkBoxFactor& f, ShapeKind kind) {
  return automatic<LandmarkBoxResidual, 4, 3, 4, 4, 3>(f, kind);
}
inline ceres::CostFunction* costOf(const CameraPointFactor& f) {
  return automatic<CameraPointResidual, 3, 3, 4, 3>(f);
}
inline ceres::CostFunction* costOf(const PointLandmarkFactor& f, ShapeKind kind) {
  return automatic<PointLandmarkResidual, 2, 3, 4, 3>(f, kind);
}
inline ceres::CostFunction* costOf(const MarginalPrior& f) {
  return new MarginalPriorCost(f);
}

}  // namespace roomgraph
