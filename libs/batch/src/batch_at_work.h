// SPDX-License-Identifier: BSD-3-Clause
// The state of a batch while its tasks go on.
#pragma once

#include <deque>
#include <map>
#include <set>

#include "display.h"
#include "file_hashes.h"
#include "memory.h"
#include "preparation.h"
#include "roomgraph/batch/batch.h"

namespace roomgraph {

/// Starts what can be started, takes in what has ended.
class BatchAtWork {
 public:
  /// All outlive it.
  BatchAtWork(const BatchPlan& plan, const std::filesystem::path& folder, const BatchProgram& program,
              RunInspector& inspector, Engine& engine, const BatchView& view, Catalogue& catalogue);

  BatchOutcome work(const std::function<bool()>& interrupted);

 private:
  /// A run that is under way.
  struct Underway {
    PreparedRun run;
    double started_s = 0;
  };
  enum class Step { kStarted, kOver, kWaits, kFull };

  std::size_t taskOfInput(std::size_t input) const { return plan_.runs.size() + input; }
  void startAll();
  Step tryRun(std::size_t run);
  Step tryInput(std::size_t input);
  void launch(std::size_t run, PreparedRun prepared);
  void takeIn(const EndedTask& ended);
  void takeInInput(std::size_t input, int exit_code);
  void takeInRun(std::size_t run, int exit_code);
  bool tryAgain(std::size_t run, const RunResult& result);
  void failWithoutRun(std::size_t run, int exit_code, const std::string& reason);
  void record(const RunResult& result, const std::filesystem::path& folder);
  void problem(const std::string& name, const std::string& reason);
  void draw();

  const BatchPlan& plan_;
  std::filesystem::path folder_;
  const BatchProgram& program_;
  Engine& engine_;
  Catalogue& catalogue_;
  FileHashes hashes_;
  RunPreparer preparer_;
  MemoryForecast forecast_;
  BatchDisplay display_;
  BatchOutcome outcome_;

  std::deque<std::size_t> waiting_;                   ///< runs
  std::map<std::size_t, PreparedRun> prepared_;       ///< of those that wait, when it is known
  std::map<std::size_t, Underway> underway_;          ///< runs
  std::map<std::size_t, double> inputs_underway_;     ///< and when they started
  std::map<std::size_t, std::string> failed_inputs_;  ///< and why
  std::set<std::size_t> ready_inputs_;
  std::map<std::string, std::size_t> recorders_;  ///< of shared detections: the run that computes them
  std::map<std::size_t, std::vector<FailedAttempt>> failures_;
  std::map<std::size_t, double> more_memory_;  ///< factor for runs that were killed
};

}  // namespace roomgraph
