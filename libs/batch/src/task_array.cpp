// SPDX-License-Identifier: BSD-3-Clause
// tasks.json, INDEX.begun and INDEX.exit of an array of tasks.
#include "task_array.h"

#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "roomgraph/batch/run_task.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using ArrayJson = nlohmann::ordered_json;

fs::path fileOf(const fs::path& folder, std::size_t index, const char* ending) {
  return folder / (std::to_string(index) + ending);
}

std::vector<std::string> startsOf(const fs::path& folder, std::size_t index) {
  std::ifstream in(fileOf(folder, index, ".begun"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

void writeTaskArray(const TaskArray& array, const fs::path& folder) {
  ArrayJson json{{"name", array.name},
                 {"starts", array.starts},
                 {"program", array.program},
                 {"tasks", ArrayJson::array()}};
  for (const auto& task : array.tasks)
    json["tasks"].push_back({{"command", task.command}, {"log", task.log.string()}});
  writeFileAtomically(folder / "tasks.json",
                      json.dump(1, ' ', false, ArrayJson::error_handler_t::replace) + "\n");
}

TaskArray readTaskArray(const fs::path& folder) {
  const fs::path file = folder / "tasks.json";
  const auto json = parseJson<ArrayJson>(readTextFile(file), file.string());
  try {
    TaskArray array{json.at("name"), {}, json.at("starts"), json.at("program")};
    for (const auto& task : json.at("tasks"))
      array.tasks.push_back({task.at("command"), task.at("log").get<std::string>()});
    return array;
  } catch (const ArrayJson::exception& error) {
    throw InputError(file.string() + ": " + firstLine(error));
  }
}

fs::path fileOfEnd(const fs::path& folder, std::size_t index) {
  return fileOf(folder, index, ".exit");
}

void writeTaskEnd(const fs::path& folder, std::size_t index, const TaskEnd& end) {
  writeFileAtomically(fileOfEnd(folder, index), std::to_string(end.exit_code) + "\n" + end.reason + "\n");
}

std::optional<TaskEnd> readTaskEnd(const fs::path& folder, std::size_t index) {
  std::ifstream in(fileOfEnd(folder, index));
  TaskEnd end;
  if (!(in >> end.exit_code)) return std::nullopt;
  std::getline(in, end.reason);
  std::getline(in, end.reason);
  return end;
}

void noteStart(const fs::path& folder, std::size_t index) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  std::ofstream(fileOf(folder, index, ".begun"), std::ios::app) << timeStamp() << ' ' << host << std::endl;
}

bool hasBegun(const fs::path& folder, std::size_t index) {
  return fs::exists(fileOf(folder, index, ".begun"));
}

std::vector<FailedAttempt> lostStarts(const fs::path& folder, std::size_t index) {
  std::vector<FailedAttempt> out;
  auto starts = startsOf(folder, index);
  if (!starts.empty()) starts.pop_back();
  for (const auto& start : starts) {
    const auto blank = start.find(' ');
    out.push_back(
        {start.substr(0, blank), 128 + SIGKILL,
         "lost on node " + start.substr(std::min(blank + 1, start.size())) + ": the queue began it again",
         0});
  }
  return out;
}

std::map<std::string, std::string> coarseStamps(const std::vector<fs::path>& files) {
  std::map<std::string, std::string> out;
  for (const auto& file : files) {
    struct stat found {};
    out[file.string()] = stat(file.c_str(), &found) == 0
                             ? std::to_string(found.st_size) + "," + std::to_string(found.st_mtim.tv_sec)
                             : "";
  }
  return out;
}

}  // namespace roomgraph
