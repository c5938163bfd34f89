// SPDX-License-Identifier: BSD-3-Clause
// RunTask: one run with its evaluations, as a file that any machine can carry out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "roomgraph/batch/job_file.h"
#include "roomgraph/catalogue/run_result.h"

namespace roomgraph {

/// One `evaluate`.
struct EvaluationStep {
  std::string report;                  ///< NAME_score.json and "NAME.figure"
  std::vector<std::string> arguments;  ///< without the report
  std::vector<std::string> needs;      ///< files of the run; one that is missing or empty: not evaluated
};

/// Everything that the process that carries a run out has to know.
struct RunTask {
  std::filesystem::path folder;  ///< of the run
  RunResult planned;             ///< with earlier failures
  bool run_again = true;         ///< false: only its evaluation
  std::vector<std::string> run;  ///< words after the program's name
  std::vector<EvaluationStep> evaluations;
  double time_limit_s = 0;  ///< 0: none
  Keep keep = Keep::kAll;
};

/// FOLDER/task.json and back. Throws RunError, InputError.
void writeRunTask(const RunTask& task, const std::filesystem::path& file);
RunTask readRunTask(const std::filesystem::path& file);

/// A whole run that is about to be evaluated: what stays when that is killed or interrupted.
RunResult withoutEvaluation(const RunTask& task);

/// Carries a task out with `program`: log in FOLDER/run.log, progress in FOLDER/progress, at the end
/// FOLDER/result.json. When `interrupted` says so, the run is told to end (SIGINT), and what it leaves counts
/// as interrupted; a whole run whose evaluation is interrupted stays complete, with that as its reason. Returns the exit code: 0 complete, 1 failed, 4 interrupted. Throws RunError when
/// result.json cannot be written.
int performRunTask(const RunTask& task, const std::filesystem::path& program,
                   const std::function<bool()>& interrupted);

/// Now, UTC, ISO 8601.
std::string timeStamp();

}  // namespace roomgraph
