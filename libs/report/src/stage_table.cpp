// SPDX-License-Identifier: BSD-3-Clause
// summary.json field by field; timings.csv by stage and by record.
#include "stage_table.h"

#include <algorithm>
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
  run.peak_memory_mb = summary.value("peak_memory_mb", 0.);
  if (!summary.contains("timings")) return;
  for (const auto& [name, spent] : summary.at("timings").items())
    run.stages.push_back(
        {name, spent.at("calls"), spent.at("mean_ms"), spent.at("max_ms"), spent.at("total_ms"), 0});
  std::stable_sort(run.stages.begin(), run.stages.end(),
                   [](const StageRow& a, const StageRow& b) { return a.total_ms > b.total_ms; });
}

struct TimingLine {
  double t = 0, ms = 0, cpu_ms = 0;
  std::string stage;
};

// "timestamp,stage,ms,cpu_ms"; nothing when it is not that.
std::optional<TimingLine> parsed(const std::string& line) {
  const auto first = line.find(','), last = line.rfind(',');
  if (first == std::string::npos || last == first) return std::nullopt;
  const auto middle = line.rfind(',', last - 1);
  if (middle == std::string::npos || middle <= first) return std::nullopt;
  TimingLine out;
  char *end_t = nullptr, *end_ms = nullptr, *end_cpu = nullptr;
  out.t = std::strtod(line.c_str(), &end_t);
  out.ms = std::strtod(line.c_str() + middle + 1, &end_ms);
  out.cpu_ms = std::strtod(line.c_str() + last + 1, &end_cpu);
  if (end_t != line.c_str() + first || end_ms != line.c_str() + last || *end_cpu > ' ') return std::nullopt;
  if (!std::isfinite(out.t + out.ms + out.cpu_ms)) return std::nullopt;
  out.stage = line.substr(first + 1, middle - first - 1);
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
  std::string line;
  std::getline(lines, line);
  for (int number = 2; std::getline(lines, line); ++number) {
    const auto call = parsed(line);
    if (!call) throw InputError(name + ":" + std::to_string(number) + ": expected timestamp,stage,ms,cpu_ms");
    cpu_ms[call->stage] += call->cpu_ms;
    if (calls[call->stage] != 1) of_record[call->t - run.start_t] += call->ms;
  }
  for (auto& stage : run.stages) stage.cpu_ms = cpu_ms[stage.name];
  run.record_ms = binned({of_record.begin(), of_record.end()}, 0, run.duration_s,
                         partsFor(of_record.size(), kRecordBins));
}

}  // namespace roomgraph
