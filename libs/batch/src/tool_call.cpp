// SPDX-License-Identifier: BSD-3-Clause
// Commands in PATH as children whose output is a file.
#include "tool_call.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

fs::path emptied(const fs::path& file) {
  std::error_code none;
  fs::create_directories(file.parent_path(), none);
  fs::remove(file, none);
  return file;
}

std::vector<std::string> withFile(std::vector<std::string> words) {
  words.front() = fileOfCommand(words.front()).string();
  return words;
}

}  // namespace

fs::path fileOfCommand(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; !folder.empty() && access(file.c_str(), X_OK) == 0)
      return file;
  throw ConfigError(name + " is no command here: --engine slurm needs those of Slurm in PATH");
}

std::string lastLineOf(const std::string& text) {
  std::istringstream in(text);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last;
}

ToolCall::ToolCall(std::vector<std::string> words, fs::path answer)
    : answer_(emptied(answer)), started_(Clock::now()), process_(withFile(std::move(words)), answer_, true) {}

std::optional<int> ToolCall::ended() {
  const auto end = process_.ended();
  return end ? std::optional<int>(end->exit_code) : std::nullopt;
}

std::string ToolCall::answer() const {
  std::ifstream in(answer_, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string ToolCall::lastWords() const {
  return lastLineOf(answer());
}

int ToolCall::wait(ToolCall& call, double limit_s) {
  const auto limit = call.started() + std::chrono::duration<double>(limit_s);
  for (bool stopped = false;; std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
    if (const auto end = call.ended()) return *end;
    if (!stopped && Clock::now() > limit) {
      call.stop();
      stopped = true;
    }
  }
}

}  // namespace roomgraph
