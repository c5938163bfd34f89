// SPDX-License-Identifier: BSD-3-Clause
// A child process that ends with this one, and what it took.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomgraph {

/// How a child ended.
struct ChildEnd {
  int exit_code = 0;  ///< 128 + n: by signal n
  double cpu_s = 0, peak_memory_mb = 0;
};

/// A running program. It is killed when this process dies, by whatever (PR_SET_PDEATHSIG), and when the
/// object goes while it runs.
class ChildProcess {
 public:
  /// `command[0]` is the program's path; no shell. What it prints is appended to `log`. `own_group`: signals
  /// of the terminal do not reach it; otherwise SIGTERM does not end it: a queue sends that to all processes
  /// of a job, and only the parent is to tell its child, once, by SIGINT. Throws RunError: cannot be started.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log, bool own_group);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept : pid_(other.pid_), end_(other.end_) { other.pid_ = 0; }
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Nothing while it runs, the same ever after.
  std::optional<ChildEnd> ended();
  void signal(int number) const;
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  std::optional<ChildEnd> end_;
};

/// What the processes of a group hold in memory now, MB.
double memoryOfGroups(const std::vector<pid_t>& groups);

}  // namespace roomgraph
