// SPDX-License-Identifier: BSD-3-Clause
// States and messages of Slurm.
#include "slurm_queue.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <set>
#include <sstream>

namespace roomgraph {

std::vector<std::string> queueQuestion() {
  return {"squeue",
          "--noheader",
          "--array",
          "--states=all",
          "--user=" + std::to_string(getuid()),
          "--format=%F|%K|%T|%r"};
}

SlurmQueue queueOf(const std::string& answer) {
  SlurmQueue queue;
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string job, index;
    QueuedTask task;
    std::getline(in, job, '|');
    std::getline(in, index, '|');
    std::getline(in, task.state, '|');
    std::getline(in, task.reason);
    const bool number =
        !index.empty() && index.size() < 10 &&
        std::all_of(index.begin(), index.end(), [](unsigned char c) { return std::isdigit(c); });
    if (number) queue[{job, std::stoul(index)}] = task;
  }
  return queue;
}

bool isActive(const std::string& state) {
  static const std::set<std::string> kActive{"PENDING",      "RUNNING",      "SUSPENDED", "CONFIGURING",
                                             "COMPLETING",   "REQUEUED",     "RESIZING",  "REQUEUE_HOLD",
                                             "REQUEUE_FED",  "SIGNALING",    "STAGE_OUT", "STOPPED",
                                             "SPECIAL_EXIT", "RESV_DEL_HOLD"};
  return kActive.contains(state);
}

QueueEnd endOfState(const std::string& state) {
  static const std::map<std::string, std::pair<int, std::string>> kEnds{
      {"CANCELLED", {128 + SIGTERM, "its job was cancelled"}},
      {"TIMEOUT", {128 + SIGTERM, "over its time limit in the queue"}},
      {"DEADLINE", {128 + SIGTERM, "over its time limit: the deadline of its job has passed"}},
      {"OUT_OF_MEMORY", {128 + SIGKILL, "its job took more memory than it asked for"}},
      {"NODE_FAIL", {1, "its node failed"}},
      {"BOOT_FAIL", {1, "its node did not start"}},
      {"PREEMPTED", {128 + SIGTERM, "its job was preempted"}}};
  const auto known = kEnds.find(state);
  if (known != kEnds.end()) return {known->second.first, known->second.second, true};
  return {1, "its job ended without a word" + (state.empty() ? "" : " (" + state + ")"), false};
}

bool isRefusedForNow(const std::string& answer) {
  for (const char* words :
       {"temporarily unable", "temporarily unavailable", "job submit limit", "SubmitJobs", "SubmitJobLimit",
        "Invalid job array specification", "Unable to contact", "timed out", "Zero Bytes were transmitted",
        "Connection refused", "in standby mode", "Unexpected missing socket"})
    if (answer.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace roomgraph
