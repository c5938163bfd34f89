// SPDX-License-Identifier: BSD-3-Clause
// Ceres cost function of a movement between two poses, differentiated by hand: long runs spend most of their solver on it.
#pragma once

#include <ceres/sized_cost_function.h>

#include "residuals.h"

namespace roomgraph {

/// Blocks: translation and quaternion (x, y, z, w) of the pose from which the movement is measured, then of the other one.
class BetweenCost : public ceres::SizedCostFunction<6, 3, 4, 3, 4> {
 public:
  explicit BetweenCost(const BetweenFactor& factor) : residual_(factor) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  BetweenResidual residual_;
};

}  // namespace roomgraph
