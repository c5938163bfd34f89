// SPDX-License-Identifier: BSD-3-Clause
// RunTask to JSON and back.
#include "roomgraph/batch/run_task.h"

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using TaskJson = nlohmann::ordered_json;

RunTask taskOf(const TaskJson& json, const std::string& name) {
  RunTask task;
  task.folder = json.at("folder").get<std::string>();
  task.run_again = json.at("run_again").get<bool>();
  task.run = json.at("run").get<std::vector<std::string>>();
  task.time_limit_s = json.at("time_limit_s").get<double>();
  task.keep = keepFromText(json.at("keep").get<std::string>());
  for (const auto& step : json.at("evaluations"))
    task.evaluations.push_back({step.at("report"), step.at("arguments"), step.at("needs")});
  task.planned = runResultOfText(json.at("planned").dump(), name);
  return task;
}

}  // namespace

void writeRunTask(const RunTask& task, const std::filesystem::path& file) {
  TaskJson json{{"folder", task.folder.string()},
                {"run_again", task.run_again},
                {"run", task.run},
                {"evaluations", TaskJson::array()},
                {"time_limit_s", task.time_limit_s},
                {"keep", toText(task.keep)},
                {"planned", TaskJson::parse(textOfRunResult(task.planned))}};
  for (const auto& step : task.evaluations)
    json["evaluations"].push_back(
        {{"report", step.report}, {"arguments", step.arguments}, {"needs", step.needs}});
  writeFileAtomically(file, json.dump(1, ' ', false, TaskJson::error_handler_t::replace) + "\n");
}

RunTask readRunTask(const std::filesystem::path& file) {
  const TaskJson json = parseJson<TaskJson>(readTextFile(file), file.string());
  try {
    return taskOf(json, file.string());
  } catch (const TaskJson::exception& error) {
    throw InputError(file.string() + ": " + firstLine(error));
  }
}

std::string timeStamp() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace roomgraph
