// SPDX-License-Identifier: BSD-3-Clause
// Engine: whatever carries the tasks of a batch out.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/batch/job_file.h"
#include "roomgraph/catalogue/run_result.h"

namespace roomgraph {

/// A command to be carried out somewhere.
struct EngineTask {
  std::size_t id = 0;                ///< chosen by whoever starts it
  std::vector<std::string> command;  ///< the program's path first
  std::filesystem::path log;
  double expected_memory_mb = 0;
  double memory_factor = 1;  ///< of a task that was killed before, perhaps for want of memory
};

/// A task that is over.
struct EndedTask {
  std::size_t id = 0;
  int exit_code = 0;                ///< 128 + n: by signal n
  std::string reason;               ///< what the engine knows of its end ("its node failed"); empty: nothing
  bool goes_on = false;             ///< it does not end: this engine has stopped watching it
  std::vector<FailedAttempt> lost;  ///< earlier starts, by a queue that starts anew what a node lost
};

/// Carries tasks out side by side. What they did is in the files that they leave; the engine only knows
/// whether they run.
class Engine {
 public:
  virtual ~Engine() = default;
  /// Whether there is room for one more now.
  virtual bool accepts(double expected_memory_mb) = 0;
  /// Throws RunError: cannot be started.
  virtual void start(const EngineTask& task) = 0;
  /// Those that ended since the last call. Throws RunError: the engine can start no task at all.
  virtual std::vector<EndedTask> ended() = 0;
  /// Tells all that run to end in good order. Returns what it did, in words.
  virtual std::string interrupt() = 0;

  /// Whether tasks are carried out by other machines than this one.
  virtual bool isElsewhere() const { return false; }
  /// Whether an earlier engine in this folder started this command, and nobody has been told how it ended.
  virtual bool remembers(const std::vector<std::string>& /*command*/) const { return false; }
  /// Goes on with what it remembers, as if it had been started now under this id.
  virtual void takeUp(std::size_t /*id*/, const std::vector<std::string>& /*command*/) {}
  /// Ends a task; ended() tells when that is done.
  virtual void cancel(std::size_t /*id*/) {}
  /// Whether it is in a queue and has not begun.
  virtual bool isQueued(std::size_t /*id*/) const { return false; }
  /// What people should know, one line each, since the last call ("sbatch: ...").
  virtual std::vector<std::string> news() { return {}; }
};

/// Child processes on this machine, each in a process group of its own: as many as `limits` and the memory
/// allow. A task starts when what is available, less what those that run may still take, holds what it is
/// expected to need; one alone always starts.
std::unique_ptr<Engine> makeLocalEngine(const BatchLimits& limits);

/// Runs at once when the limits do not say: cores that this process may use, divided by the threads of a run.
int jobsOf(const BatchLimits& limits);

/// What a Slurm engine has to know besides the job file.
struct SlurmPlaces {
  std::filesystem::path folder;              ///< of the batch; the nodes see it under the same name
  std::filesystem::path program;             ///< the same
  std::vector<std::filesystem::path> parts;  ///< of the program; a node refuses when they have been replaced
};

/// Array jobs of Slurm, by its commands. Everything known of them is in FOLDER/slurm, so that another engine
/// can go on after this one was killed. `leaves_jobs`: asked by interrupt(); true: the jobs go on without
/// being watched, else they are cancelled. Throws ConfigError: there are no such commands here.
std::unique_ptr<Engine> makeSlurmEngine(const JobFile& jobs, const SlurmPlaces& places,
                                        std::function<bool()> leaves_jobs);

/// The script of an array of `tasks` runs as it would be submitted. `memory_mb`: that one is expected to
/// need.
std::string slurmScriptOf(const JobFile& jobs, const SlurmPlaces& places, std::size_t tasks,
                          double memory_mb);

/// Whether FOLDER/slurm holds tasks of which nobody has been told how they ended.
bool hasSlurmTasks(const std::filesystem::path& folder);

/// On a node: carries one task of an array out, and leaves word in ARRAY/INDEX.exit. Returns its exit code.
/// Throws InputError: there is no such task any more.
int performArrayTask(const std::filesystem::path& array, std::size_t index,
                     const std::function<bool()>& interrupted);

}  // namespace roomgraph
