// SPDX-License-Identifier: BSD-3-Clause
// What a node does with one task of an array.
#include <csignal>
#include <thread>

#include "child_process.h"
#include "roomgraph/batch/engine.h"
#include "roomgraph/core/errors.h"
#include "task_array.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kLookAtChild = std::chrono::milliseconds(20);
constexpr auto kLookAtFolder = std::chrono::seconds(2);

// Nobody waits for this task any more: the batch gave it up, and perhaps started it elsewhere.
bool isGivenUp(const fs::path& array, std::size_t index) {
  std::error_code unreachable;  // a shared folder that does not answer now is no word
  return readTaskEnd(array, index) || (!fs::exists(array / "tasks.json", unreachable) && !unreachable);
}

std::string whyNot(const TaskArray& array, const fs::path& folder, std::size_t index) {
  std::vector<fs::path> files;
  for (const auto& [file, stamp] : array.program) files.emplace_back(file);
  if (coarseStamps(files) != array.program)
    return "the program has been replaced since the job was submitted";
  const auto lost = lostStarts(folder, index);
  if (lost.size() >= static_cast<std::size_t>(array.starts)) return lost.back().reason;
  return "";
}

// A task that was told to end, and that the queue begins anew all the same: it was requeued.
void forgetInterruption(const fs::path& folder, std::size_t index) {
  const auto end = readTaskEnd(folder, index);
  std::error_code none;
  if (end && end->exit_code == kInterrupted && end->reason.empty())
    fs::remove(fileOfEnd(folder, index), none);
}

}  // namespace

int performArrayTask(const fs::path& folder, std::size_t index, const std::function<bool()>& interrupted) {
  const TaskArray array = readTaskArray(folder);
  forgetInterruption(folder, index);
  if (index >= array.tasks.size() || isGivenUp(folder, index))
    throw InputError(folder.string() + ": has no task " + std::to_string(index) + " to be done");
  noteStart(folder, index);
  if (const std::string reason = whyNot(array, folder, index); !reason.empty()) {
    writeTaskEnd(folder, index, {1, reason});
    return 1;
  }
  ChildProcess child(array.tasks[index].command, array.tasks[index].log, false);
  bool told = false;
  for (auto looked = Clock::now();; std::this_thread::sleep_for(kLookAtChild)) {
    if (const auto end = child.ended()) {
      // One that does not end in good order when it is told to has been told all the same.
      const int exit_code = told && end->exit_code > 128 ? kInterrupted : end->exit_code;
      if (!isGivenUp(folder, index)) writeTaskEnd(folder, index, {exit_code, ""});
      return exit_code;
    }
    if (!told && interrupted()) {
      child.signal(SIGINT);
      told = true;
    }
    if (Clock::now() - looked < kLookAtFolder) continue;
    looked = Clock::now();
    if (isGivenUp(folder, index)) return 1;  // the child is killed with its object
  }
}

}  // namespace roomgraph
