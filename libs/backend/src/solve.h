// SPDX-License-Identifier: BSD-3-Clause
// Solver options, silent solve and silent evaluation of a Ceres problem.
#pragma once

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <vector>

#include "roomgraph/backend/factor_graph.h"

namespace roomgraph {

/// While it lives. CHOLMOD shares out every supernode among four threads, whatever it is asked for. Our matrices are small:
/// threads take longer to wake than to work, and far longer when other programs need the cores. The level is the calling
/// thread's.
class SerialCholmod {
 public:
  SerialCholmod();
  ~SerialCholmod();
  SerialCholmod(const SerialCholmod&) = delete;
  SerialCholmod& operator=(const SerialCholmod&) = delete;

 private:
  int levels_;
};

/// The solver's options: sparse Cholesky, one thread, silent.
ceres::Solver::Options solverOptions(const SolveOptions& options);
/// Runs Ceres without output on stderr.
SolveReport solve(const SolveOptions& options, ceres::Solver::Options solver, ceres::Problem& problem);
/// Evaluates, without output on stderr. False, and no output values, when a residual or derivative is not finite.
bool evaluate(ceres::Problem& problem, const ceres::Problem::EvaluateOptions& options, double* cost,
              std::vector<double>* residuals, ceres::CRSMatrix* jacobian);
/// Half the sum of squared (robust, weighted) residuals; NaN when it cannot be evaluated.
double costNow(ceres::Problem& problem);

}  // namespace roomgraph
