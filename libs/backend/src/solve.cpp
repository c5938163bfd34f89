// SPDX-License-Identifier: BSD-3-Clause
// Ceres calls with its log silenced, iteration callback, and report of a solve.
#include "solve.h"

#include <glog/logging.h>

#include <limits>
#include <mutex>

// Of the OpenMP runtime, where CHOLMOD, which Ceres calls, was built with one.
extern "C" {
[[gnu::weak]] int omp_get_max_active_levels();
[[gnu::weak]] void omp_set_max_active_levels(int levels);
}

namespace roomgraph {

SerialCholmod::SerialCholmod() : levels_(omp_get_max_active_levels ? omp_get_max_active_levels() : 0) {
  if (omp_set_max_active_levels) omp_set_max_active_levels(0);
}

SerialCholmod::~SerialCholmod() {
  if (omp_set_max_active_levels) omp_set_max_active_levels(levels_);
}

namespace {

// In standard deviations of all variables together. Ceres begins with 10000: where the first step fails, ten more are
// spent on halving that.
constexpr double kDoglegRadius = 100;

// Keeps Ceres from writing to stderr what its result says as well: that something is singular or not finite. The log
// level is global: of several simultaneous calls the first that begins changes it and the last that ends restores it.
class QuietCeres {
 public:
  QuietCeres() {
    const std::lock_guard lock(mutex_);
    if (solves_++ > 0) return;
    level_ = FLAGS_minloglevel;
    FLAGS_minloglevel = google::GLOG_FATAL;
  }
  ~QuietCeres() {
    const std::lock_guard lock(mutex_);
    if (--solves_ == 0) FLAGS_minloglevel = level_;
  }
  QuietCeres(const QuietCeres&) = delete;
  QuietCeres& operator=(const QuietCeres&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int solves_ = 0, level_ = 0;
};

class Watcher : public ceres::IterationCallback {
 public:
  explicit Watcher(const SolveOptions& options) : options_(options) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    options_.progress(summary.iteration, summary.cost);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const SolveOptions& options_;
};

}  // namespace

ceres::Solver::Options solverOptions(const SolveOptions& options) {
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.max_iterations;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.num_threads = 1;  // one order of summation: the same bits on every run
  solver.function_tolerance = options.function_tolerance;
  solver.logging_type = ceres::SILENT;
  if (options.dogleg) {
    solver.trust_region_strategy_type = ceres::DOGLEG;
    solver.dogleg_type = ceres::SUBSPACE_DOGLEG;
    solver.initial_trust_region_radius = kDoglegRadius;
  }
  return solver;
}

SolveReport solve(const SolveOptions& options, ceres::Solver::Options solver, ceres::Problem& problem) {
  Watcher watcher(options);
  if (options.progress) solver.callbacks.push_back(&watcher);
  ceres::Solver::Summary summary;
  const QuietCeres quiet;
  const SerialCholmod serial;
  ceres::Solve(solver, &problem, &summary);
  return {summary.IsSolutionUsable(), summary.initial_cost, summary.final_cost,
          static_cast<int>(summary.iterations.size()), summary.message};
}

bool evaluate(ceres::Problem& problem, const ceres::Problem::EvaluateOptions& options, double* cost,
              std::vector<double>* residuals, ceres::CRSMatrix* jacobian) {
  const QuietCeres quiet;
  return problem.Evaluate(options, cost, residuals, nullptr, jacobian);
}

double costNow(ceres::Problem& problem) {
  double cost = 0;
  return evaluate(problem, {}, &cost, nullptr, nullptr) ? cost : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace roomgraph
