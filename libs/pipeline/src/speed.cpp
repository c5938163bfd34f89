// SPDX-License-Identifier: BSD-3-Clause
// Sums over the calls of stages, the waiting line, and the table.
#include "roomgraph/pipeline/speed.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

template <class... Values>
std::string line(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

ordered_json jsonOf(const DurationFigures& f) {
  return {{"count", f.count},
          {"mean_ms", f.mean_ms},
          {"median_ms", f.median_ms},
          {"p99_ms", f.p99_ms},
          {"max_ms", f.max_ms}};
}

std::string row(const std::string& name, const DurationFigures& f) {
  return line("%-22s %7d %9.2f %9.2f %9.2f %9.1f", name.c_str(), f.count, f.mean_ms, f.median_ms, f.p99_ms,
              f.max_ms);
}

}  // namespace

DurationFigures figuresOf(const std::vector<double>& durations_ms) {
  DurationFigures out;
  out.count = static_cast<int>(durations_ms.size());
  if (durations_ms.empty()) return out;
  out.mean_ms = std::accumulate(durations_ms.begin(), durations_ms.end(), 0.0) / out.count;
  out.median_ms = median(durations_ms);
  out.p99_ms = quantile(durations_ms, 0.99);
  out.max_ms = *std::max_element(durations_ms.begin(), durations_ms.end());
  return out;
}

std::vector<StageSpeed> speedOfStages(const StageTimes& times) {
  std::map<std::string, std::vector<double>> calls;
  std::map<std::string, double> cpu;
  for (const auto& call : times.calls()) {
    calls[call.stage].push_back(call.ms);
    cpu[call.stage] += call.cpu_ms;
  }
  std::vector<StageSpeed> out;
  for (const auto& [stage, ms] : calls)
    out.push_back({stage, figuresOf(ms), std::accumulate(ms.begin(), ms.end(), 0.0), cpu[stage]});
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.total_ms > b.total_ms; });
  return out;
}

double WaitingLine::serve(double arrival_s, double work_s) {
  free_s_ = std::max(free_s_, arrival_s) + work_s;
  return free_s_ - arrival_s;
}

void LatencySink::onStep(const StepReport& report) {
  const double now_ms = threadTime_ms(), work_s = (now_ms - before_ms_) / 1e3;
  before_ms_ = now_ms;
  const double latency_ms = 1e3 * line_.serve(report.t, work_s);
  if (report.kind == StepReport::Kind::kFrame) frames_ms_.push_back(latency_ms);
  if (report.kind == StepReport::Kind::kScan) scans_ms_.push_back(latency_ms);
}

std::string toTable(const SpeedReport& r) {
  std::string out =
      line("%.1f s recorded, run in %.1f s: %.2f x real time; %.2f of %d cores, %.0f MB at most\n",
           r.recorded_s, r.wall_s, r.timesRealTime(), r.cores(), r.threads, r.peak_memory_mb);
  out += line("after the last record: %.1f s, %.2f s for each minute recorded\n\n", r.end_s,
              r.recorded_s > 0 ? 60 * r.end_s / r.recorded_s : 0.0);
  out += line("%-22s %7s %9s %9s %9s %9s %9s %7s\n", "stage", "calls", "mean ms", "median", "99 %", "max",
              "total s", "cores");
  for (const auto& stage : r.stages)
    out += row(stage.stage, stage.call) +
           line(" %9.1f %7.3f\n", stage.total_ms / 1e3, r.wall_s > 0 ? stage.cpu_ms / 1e3 / r.wall_s : 0.0);
  out += line("\n%-22s %7s %9s %9s %9s %9s\n", "latency", "records", "mean ms", "median", "99 %", "max");
  if (r.frames.count > 0) out += row("RGB-D frames", r.frames) + "\n";
  if (r.scans.count > 0) out += row("scans", r.scans) + "\n";
  return out;
}

std::string toJson(const SpeedReport& r) {
  ordered_json out = {{"recorded_s", r.recorded_s},
                      {"wall_s", r.wall_s},
                      {"times_real_time", r.timesRealTime()},
                      {"cpu_s", r.cpu_s},
                      {"threads", r.threads},
                      {"end_s", r.end_s},
                      {"peak_memory_mb", r.peak_memory_mb},
                      {"stages", ordered_json::array()},
                      {"latency", {{"frames", jsonOf(r.frames)}, {"scans", jsonOf(r.scans)}}}};
  for (const auto& stage : r.stages) {
    ordered_json entry = {{"stage", stage.stage}, {"total_ms", stage.total_ms}, {"cpu_ms", stage.cpu_ms}};
    entry.update(jsonOf(stage.call));
    out["stages"].push_back(entry);
  }
  return out.dump(2) + "\n";
}

}  // namespace roomgraph
