// SPDX-License-Identifier: BSD-3-Clause
// summary.json field by field; timings.csv by stage and by record.
#include "stage_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "path_thinning.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

constexpr int kRecordBins = 360;

std::map<std::string, double> numbersOf(const json& summary, const char* key) {
  std::map<std::string, double> out;
  if (summary.contains(key))
    for (const auto& [name, value] : summary.at(key).items())
      if (value.is_number()) out[name] = value.get<double>();
  return out;
}

std::string commandOf(const json& summary) {
  std::string text;
  if (summary.contains("command"))
    for (const json& word : summary.at("command"))
      text += (text.empty() ? "" : " ") + word.get<std::string>();
  return text;
}

void fill(const json& summary, RunData& run) {
  run.input = summary.value("input", "");
  run.version = summary.value("version", "") + " (" + summary.value("revision", "") + ")";
  run.command = commandOf(summary);
  run.interrupted = summary.value("interrupted", "no");
  run.counts = numbersOf(summary, "counts");
  run.reasons = numbersOf(summary, "reasons");
  run.records_used = numbersOf(summary, "records_used");
  run.records_skipped = numbersOf(summary, "records_skipped");
  run.run_warnings.push_back(summary.value("input_warning", ""));
  if (summary.contains("sensor_warnings"))
    for (const json& warning : summary.at("sensor_warnings")) run.run_warnings.push_back(warning);
  std::erase(run.run_warnings, "");
  if (const auto found = summary.find("findings"); found != summary.end() && found->is_array()) {
    run.findings.emplace();
    for (const json& one : *found)
      run.findings->push_back({one.at("severity"), one.at("place"), one.at("what"), one.at("hint")});
  }
  run.peak_memory_mb = summary.value("peak_memory_mb", 0.);
  run.wall_s = summary.value("wall_s", 0.);
  if (!summary.contains("timings")) return;
  for (const auto& [name, spent] : summary.at("timings").items())
    run.stages.push_back(
        {name, spent.at("calls"), spent.at("mean_ms"), spent.at("max_ms"), spent.at("total_ms"), 0});
  std::stable_sort(run.stages.begin(), run.stages.end(),
                   [](const StageRow& a, const StageRow& b) { return a.total_ms > b.total_ms; });
}

struct TimingLine {
  double t = 0;
  std::string stage;
  std::array<double, 3> values{};  // ms, cpu_ms, memory_mb
};

const std::string kColumns = "timestamp,stage,ms,cpu_ms", kColumnsWithMemory = kColumns + ",memory_mb";

// Time, stage and so many values behind it, from the end: a name may hold commas. Nothing when it is not
// that.
std::optional<TimingLine> parsed(const std::string& line, int values) {
  const auto first = line.find(',');
  if (first == std::string::npos) return std::nullopt;
  TimingLine out;
  char* end = nullptr;
  out.t = std::strtod(line.c_str(), &end);
  if (end != line.c_str() + first || !std::isfinite(out.t)) return std::nullopt;
  std::size_t behind = line.find_last_not_of("\r") + 1;
  for (int i = values; i-- > 0;) {
    const auto comma = line.rfind(',', behind - 1);
    if (comma <= first) return std::nullopt;
    double& value = out.values[static_cast<std::size_t>(i)] = std::strtod(line.c_str() + comma + 1, &end);
    if (end != line.c_str() + behind || !std::isfinite(value)) return std::nullopt;
    behind = comma;
  }
  out.stage = line.substr(first + 1, behind - first - 1);
  return out;
}

}  // namespace

void readSummary(const std::filesystem::path& file, RunData& run) {
  const json summary = parseJson<json>(readTextFile(file), file.string());
  try {
    fill(summary, run);
  } catch (const json::exception& error) {
    throw InputError(file.string() + ": " + firstLine(error));
  }
}

void readTimings(std::istream& lines, const std::string& name, RunData& run) {
  std::map<std::string, double> cpu_ms;
  std::map<std::string, int> calls;
  for (const auto& stage : run.stages) calls[stage.name] = stage.calls;
  std::map<double, double> of_record;
  std::vector<std::pair<double, double>> memory_mb;
  std::string line;
  std::getline(lines, line);
  const bool with_memory = line.starts_with(kColumnsWithMemory);
  for (int number = 2; std::getline(lines, line); ++number) {
    const auto call = parsed(line, with_memory ? 3 : 2);
    if (!call)
      throw InputError(name + ":" + std::to_string(number) + ": expected " +
                       (with_memory ? kColumnsWithMemory : kColumns));
    const auto [ms, cpu, memory] = call->values;
    cpu_ms[call->stage] += cpu;
    if (calls[call->stage] != 1) of_record[call->t - run.start_t] += ms;
    if (memory > 0) memory_mb.emplace_back(std::clamp(call->t - run.start_t, 0., run.duration_s), memory);
  }
  for (auto& stage : run.stages) stage.cpu_ms = cpu_ms[stage.name];
  run.record_ms = binned({of_record.begin(), of_record.end()}, 0, run.duration_s,
                         partsFor(of_record.size(), kRecordBins));
  run.memory_mb = binned(memory_mb, 0, run.duration_s, partsFor(of_record.size(), kRecordBins));
}

}  // namespace roomgraph
