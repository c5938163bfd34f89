// SPDX-License-Identifier: BSD-3-Clause
// What squeue and sbatch say, understood.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace roomgraph {

/// A task of an array job in the queue.
struct QueuedTask {
  std::string state;   ///< "PENDING", "RUNNING", "CANCELLED"...
  std::string reason;  ///< why it waits ("Resources")
};

/// By the id of the array job and the index.
using SlurmQueue = std::map<std::pair<std::string, std::size_t>, QueuedTask>;

/// Words after `squeue` that print all jobs of this user, also those that are over and not yet forgotten.
std::vector<std::string> queueQuestion();
/// Its answer.
SlurmQueue queueOf(const std::string& answer);

/// Whether a task in this state may still do something.
bool isActive(const std::string& state);

/// How a task in this state, which left no word, is taken to have ended.
struct QueueEnd {
  int exit_code = 1;
  std::string reason;
  bool by_queue = false;  ///< the queue ended it, or knows why it ended
};
QueueEnd endOfState(const std::string& state);

/// Whether sbatch refused for the moment, not for good: the queue is full, or the controller is away.
bool isRefusedForNow(const std::string& answer);

}  // namespace roomgraph
