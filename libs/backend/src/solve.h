// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <ceres/ceres.h>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// The solver's options: sparse Cholesky, one thread, silent.
ceres::Solver::Options solverOptions(const SolveOptions& options);
/// Runs Ceres; it writes nothing to stderr.
SolveReport solve(const SolveOptions& options, ceres::Solver::Options solver, ceres::Problem& problem);
/// Half the sum of squared (robust, weighted) residuals.
double costNow(ceres::Problem& problem);

}  // namespace roomgraph
