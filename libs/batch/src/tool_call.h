// SPDX-License-Identifier: BSD-3-Clause
// A command of another program that answers in its own time.
#pragma once

#include <chrono>

#include "child_process.h"

namespace roomgraph {

/// A command that runs while others things go on.
class ToolCall {
 public:
  using Clock = std::chrono::steady_clock;
  /// `words[0]` is searched in PATH. What it prints goes to the file `answer`. Throws ConfigError: there is
  /// no such command.
  ToolCall(std::vector<std::string> words, std::filesystem::path answer);

  /// Its exit code; nothing while it runs.
  std::optional<int> ended();
  /// What it has printed so far.
  std::string answer() const;
  /// Its last line that is not empty, for messages.
  std::string lastWords() const;
  /// Ends it at once.
  void stop() const { process_.signal(9); }
  Clock::time_point started() const { return started_; }

  /// Runs a command to its end, for at most so many seconds. Returns its exit code.
  static int wait(ToolCall& call, double limit_s);

 private:
  std::filesystem::path answer_;
  Clock::time_point started_;
  ChildProcess process_;
};

/// The file of a command in PATH. Throws ConfigError: there is none.
std::filesystem::path fileOfCommand(const std::string& name);

/// The last line of a text that is not empty.
std::string lastLineOf(const std::string& text);

}  // namespace roomgraph
