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
    bool outdated = false;  ///< it was started by an earlier batch, and something has changed since
  };
  enum class Step { kStarted, kOver, kWaits, kFull };

  std::size_t taskOfRun(std::size_t run) const { return plan_.inputs.size() + run; }
  std::vector<std::string> commandOf(std::size_t run) const;
  void startAll();
  void takeUp(std::size_t run);
  Step tryRun(std::size_t run);
  Step tryInput(std::size_t input);
  Step startInput(EngineTask task);
  EngineTask simulationOf(std::size_t input) const;
  EngineTask measurementOf(std::size_t input) const;
  bool isMeasured(std::size_t input);
  bool waitsForPieces(std::size_t run);
  void split(std::size_t run);
  void launch(std::size_t run, PreparedRun prepared);
  void takeIn(const EndedTask& ended);
  void takeInInput(std::size_t input, const EndedTask& ended);
  void takeInRun(std::size_t run, const EndedTask& ended);
  RunResult resultOf(const Underway& under, const EndedTask& ended);
  double memoryOf(std::size_t run, const RunInput& recording);
  bool tryAgain(std::size_t run, const RunResult& result);
  void failWithoutRun(std::size_t run, int exit_code, const std::string& reason);
  void record(const RunResult& result, const std::filesystem::path& folder);
  void problem(const std::string& name, const std::string& reason);
  void draw();

  BatchPlan plan_;  ///< grows by pieces
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
  std::map<std::size_t, std::string> over_;       ///< runs, and why they failed; empty: they are complete
  std::set<std::size_t> split_;                   ///< runs whose pieces are known
  std::map<std::string, std::size_t> recorders_;  ///< of shared detections: the run that computes them
  std::map<std::size_t, std::vector<FailedAttempt>> failures_;
  std::map<std::size_t, double> more_memory_;  ///< factor for runs that were killed
};

}  // namespace roomgraph
