// SPDX-License-Identifier: BSD-3-Clause
// Child processes within the bounds of cores and memory.
#include <sched.h>

#include <algorithm>
#include <csignal>

#include "child_process.h"
#include "memory.h"
#include "roomgraph/batch/engine.h"

namespace roomgraph {
namespace {

struct RunningChild {
  std::size_t id;
  double expected_memory_mb;
  ChildProcess process;
};

class LocalEngine : public Engine {
 public:
  explicit LocalEngine(const BatchLimits& limits)
      : limits_(limits), jobs_(static_cast<std::size_t>(jobsOf(limits))) {}

  bool accepts(double expected_memory_mb) override {
    if (running_.empty()) return true;
    if (running_.size() >= jobs_) return false;
    std::vector<pid_t> groups;
    double promised = 0;
    for (const auto& child : running_) {
      groups.push_back(child.process.pid());
      promised += child.expected_memory_mb;
    }
    const double held = memoryOfGroups(groups);
    const double still_to_come = std::max(0.0, promised - held);
    double room = availableMemory() - still_to_come;
    if (limits_.memory_mb > 0) room = std::min(room, limits_.memory_mb - std::max(promised, held));
    return expected_memory_mb <= room;
  }

  void start(const EngineTask& task) override {
    running_.push_back({task.id, task.expected_memory_mb, ChildProcess(task.command, task.log, true)});
  }

  std::vector<EndedTask> ended() override {
    std::vector<EndedTask> out;
    std::vector<RunningChild> still;
    for (auto& child : running_) {
      if (const auto end = child.process.ended())
        out.push_back({child.id, end->exit_code, "", false, {}});
      else
        still.push_back(std::move(child));
    }
    running_.swap(still);
    return out;
  }

  std::string interrupt() override {
    for (const auto& child : running_) child.process.signal(SIGINT);
    return "interrupted: what runs is told to end; once more kills it";
  }

 private:
  BatchLimits limits_;
  std::size_t jobs_;
  std::vector<RunningChild> running_;
};

}  // namespace

int jobsOf(const BatchLimits& limits) {
  if (limits.jobs > 0) return limits.jobs;
  cpu_set_t cores;
  const int count = sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
  return std::max(1, count / std::max(1, limits.threads));
}

std::unique_ptr<Engine> makeLocalEngine(const BatchLimits& limits) {
  return std::make_unique<LocalEngine>(limits);
}

}  // namespace roomgraph
