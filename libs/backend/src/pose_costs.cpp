// SPDX-License-Identifier: BSD-3-Clause
// Cost functions of movements, ground, landmark positions and marginal priors.
#include "automatic_cost.h"
#include "between_cost.h"
#include "costs.h"
#include "marginal_prior_cost.h"
#include "residuals.h"

namespace roomgraph {

ceres::CostFunction* costOf(const BetweenFactor& factor) {
  return new BetweenCost(factor);
}
ceres::CostFunction* costOf(const PlanarFactor& factor) {
  return automatic<PlanarResidual, 3, 3, 4>(factor);
}
ceres::CostFunction* costOf(const GroundFactor& factor) {
  return automatic<GroundResidual, 3, 3, 4>(factor);
}
ceres::CostFunction* costOf(const LandmarkFactor& factor) {
  return automatic<LandmarkResidual, 4, 3, 4, 4>(factor);
}
ceres::CostFunction* costOf(const LandmarkViewFactor& factor) {
  return automatic<LandmarkViewResidual, 4, 4, 4, 3>(factor);
}
ceres::CostFunction* costOf(const LandmarkGroundFactor& factor) {
  return automatic<LandmarkGroundResidual, 1, 4>(factor);
}
ceres::CostFunction* costOf(const MarginalPrior& factor) {
  return new MarginalPriorCost(factor);
}

}  // namespace roomgraph
