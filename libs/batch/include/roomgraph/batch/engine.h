// SPDX-License-Identifier: BSD-3-Clause
// Engine: whatever carries the tasks of a batch out.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/batch/job_file.h"

namespace roomgraph {

/// A command to be carried out somewhere.
struct EngineTask {
  std::size_t id = 0;                ///< chosen by whoever starts it
  std::vector<std::string> command;  ///< the program's path first
  std::filesystem::path log;
  double expected_memory_mb = 0;
};

/// A task that is over.
struct EndedTask {
  std::size_t id = 0;
  int exit_code = 0;  ///< 128 + n: by signal n
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
  /// Those that ended since the last call.
  virtual std::vector<EndedTask> ended() = 0;
  /// Tells all that run to end in good order.
  virtual void interrupt() = 0;
};

/// Child processes on this machine, each in a process group of its own: as many as `limits` and the memory
/// allow. A task starts when what is available, less what those that run may still take, holds what it is
/// expected to need; one alone always starts.
std::unique_ptr<Engine> makeLocalEngine(const BatchLimits& limits);

/// Runs at once when the limits do not say: cores that this process may use, divided by the threads of a run.
int jobsOf(const BatchLimits& limits);

}  // namespace roomgraph
