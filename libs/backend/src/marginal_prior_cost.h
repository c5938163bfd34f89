// SPDX-License-Identifier: BSD-3-Clause
// Ceres cost function of a marginal prior: dense linear residual on tangents.
#pragma once

#include <ceres/cost_function.h>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// Tangent dimensions of a variable in a MarginalPrior.
constexpr int kPoseTangent = 6, kLandmarkTangent = 7, kPointTangent = 3;

/// root d + offset. Blocks: per pose translation and quaternion, per landmark (x, y, z, yaw) and size, per
/// point its position; all in the prior's order. Differentiated by hand: the matrix is dense and large.
class MarginalPriorCost : public ceres::CostFunction {
 public:
  /// Throws std::invalid_argument when the sizes do not fit each other.
  explicit MarginalPriorCost(const MarginalPrior& prior);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Eigen::VectorXd difference(double const* const* blocks) const;
  MarginalPrior prior_;
  std::vector<Eigen::Quaterniond> rotations_;
};

}  // namespace roomgraph
