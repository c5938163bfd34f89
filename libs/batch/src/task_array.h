// SPDX-License-Identifier: BSD-3-Clause
// The files of an array of tasks in a shared folder: what is to be done, and how far each task is.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/catalogue/run_result.h"

namespace roomgraph {

/// One command of an array.
struct ArrayCommand {
  std::vector<std::string> command;
  std::filesystem::path log;
};

/// ARRAY/tasks.json: all that a node has to know.
struct TaskArray {
  std::string name;  ///< of its job, unlike that of any other
  std::vector<ArrayCommand> tasks;
  int starts = 1;                              ///< of one task, at most: a queue may start it again
  std::map<std::string, std::string> program;  ///< its files and their stamps, when it was submitted
};

/// Throws RunError, InputError.
void writeTaskArray(const TaskArray& array, const std::filesystem::path& folder);
TaskArray readTaskArray(const std::filesystem::path& folder);

constexpr int kInterrupted = 4;  ///< exit code of a task that was told to end

/// How a task of an array ended.
struct TaskEnd {
  int exit_code = 0;
  std::string reason;  ///< beyond what the task itself has written; may be empty
};

/// ARRAY/INDEX.exit: there once, whoever wrote it, and then the task is over.
void writeTaskEnd(const std::filesystem::path& folder, std::size_t index, const TaskEnd& end);
std::filesystem::path fileOfEnd(const std::filesystem::path& folder, std::size_t index);
std::optional<TaskEnd> readTaskEnd(const std::filesystem::path& folder, std::size_t index);

/// ARRAY/INDEX.begun: a line for each time that a node began with it.
void noteStart(const std::filesystem::path& folder, std::size_t index);
/// Those that were followed by another one.
std::vector<FailedAttempt> lostStarts(const std::filesystem::path& folder, std::size_t index);
bool hasBegun(const std::filesystem::path& folder, std::size_t index);

/// Size and time in seconds of each file: finer times are not the same on all nodes.
std::map<std::string, std::string> coarseStamps(const std::vector<std::filesystem::path>& files);

}  // namespace roomgraph
