// SPDX-License-Identifier: BSD-3-Clause
// Ceres cost function with automatic derivatives of a residual.
#pragma once

#include <ceres/autodiff_cost_function.h>

namespace roomgraph {

/// Cost function of `Count` residuals on parameter blocks of the sizes `Blocks`; the caller owns it. The residual is
/// made from the arguments.
template <class Residual, int Count, int... Blocks, class... Arguments>
ceres::CostFunction* automatic(const Arguments&... arguments) {
  return new ceres::AutoDiffCostFunction<Residual, Count, Blocks...>(new Residual(arguments...));
}

}  // namespace roomgraph
