// SPDX-License-Identifier: BSD-3-Clause
// Every part of a run's data as JSON, rounded, escaped for HTML.
#include "data_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/base64.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

ordered_json rounded(double value, int digits = 4) {
  if (!std::isfinite(value)) return nullptr;
  const double factor = std::pow(10, digits), scaled = std::round(value * factor);
  if (std::abs(scaled) > 1e15) return value;
  return scaled / factor + 0.0;  // no negative zero
}

template <class Range>
ordered_json roundedList(const Range& values, int digits = 4) {
  ordered_json out = ordered_json::array();
  for (const double value : values) out.push_back(rounded(value, digits));
  return out;
}

ordered_json seriesJson(const BinnedSeries& series) {
  return {{"from", rounded(series.from)},
          {"step", rounded(series.step, 6)},
          {"low", roundedList(series.low)},
          {"high", roundedList(series.high)}};
}

// Flat: t, x, y, yaw, t, x, …
ordered_json pathJson(const std::vector<PathPoint>& path) {
  ordered_json out = ordered_json::array();
  for (const auto& p : path)
    for (const double value : {p.t, p.x, p.y, p.yaw}) out.push_back(rounded(value, 3));
  return out;
}

ordered_json statisticsJson(const ErrorStatistics& s) {
  return {{"rmse", rounded(s.rmse, 6)},
          {"mean", rounded(s.mean, 6)},
          {"median", rounded(s.median, 6)},
          {"p95", rounded(s.p95, 6)},
          {"max", rounded(s.max, 6)}};
}

ordered_json errorsJson(const std::optional<ReportedErrors>& errors) {
  if (!errors) return nullptr;
  return {{"pairs", errors->figures.pairs},
          {"coverage", rounded(errors->figures.coverage)},
          {"ate_m", statisticsJson(errors->figures.ate_m)},
          {"rpe_trans_m", statisticsJson(errors->figures.rpe_trans_m)},
          {"rpe_rot_deg", statisticsJson(errors->figures.rpe_rot_deg)},
          {"position_m", seriesJson(errors->position_m)},
          {"rotation_deg", seriesJson(errors->rotation_deg)}};
}

ordered_json gridJson(const std::optional<GridImage>& grid) {
  if (!grid) return nullptr;
  return {{"png", toBase64(grid->png)},    {"width", grid->width},
          {"height", grid->height},        {"cell_m", rounded(grid->cell_m, 6)},
          {"x_min", rounded(grid->x_min)}, {"y_min", rounded(grid->y_min)}};
}

ordered_json sightingsJson(const std::optional<SightingSummary>& s) {
  if (!s) return nullptr;
  ordered_json rivals = ordered_json::array();
  for (const auto& [id, sum] : s->rivals) rivals.push_back({{"id", id}, {"sum", rounded(sum, 3)}});
  return {{"count", s->count},
          {"made_new", s->made_new},
          {"first", rounded(s->first_t, 2)},
          {"last", rounded(s->last_t, 2)},
          {"mean_probability", rounded(s->mean_probability)},
          {"least_probability", rounded(s->least_probability)},
          {"doubtful", s->doubtful},
          {"rivals", rivals},
          {"over_time", s->over_time}};
}

ordered_json objectJson(const ReportedObject& o) {
  ordered_json footprint = ordered_json::array();
  for (const auto& corner : o.footprint) footprint.push_back(roundedList(corner, 3));
  ordered_json out{{"id", o.id},
                   {"class", o.class_name},
                   {"model", o.model},
                   {"shape", o.shape},
                   {"in_map", o.in_map},
                   {"place", roundedList(std::array{o.x, o.y, o.z}, 4)},
                   {"yaw", o.has_yaw ? rounded(o.yaw) : ordered_json(nullptr)},
                   {"size", roundedList(o.size)},
                   {"footprint", footprint},
                   {"covariance", roundedList(o.covariance_xy, 8)},
                   {"z_sigma_m", rounded(o.z_sigma_m)},
                   {"yaw_sigma_rad", rounded(o.yaw_sigma_rad)},
                   {"existence", rounded(o.existence)},
                   {"observations", o.observations},
                   {"sightings", sightingsJson(o.sightings)}};
  out["posterior"] = ordered_json::object();
  for (const auto& [name, p] : o.class_posterior) out["posterior"][name] = rounded(p);
  out["evidence"] = ordered_json::object();
  for (const auto& [name, value] : o.evidence) out["evidence"][name] = rounded(value);
  if (!o.view.empty()) out["view"] = o.view;
  return out;
}

ordered_json configJson(const std::vector<ConfigRow>& rows) {
  ordered_json out = ordered_json::array();
  for (const auto& row : rows) {
    out.push_back({{"section", row.section}, {"key", row.key}, {"value", row.value}});
    if (row.changed) out.back()["shipped"] = row.shipped;
  }
  return out;
}

ordered_json evaluationsJson(const std::vector<EvaluationFile>& files) {
  ordered_json out = ordered_json::array();
  for (const auto& file : files) {
    ordered_json bins = ordered_json::array();
    for (const auto& bin : file.reliability)
      bins.push_back({{"from", rounded(bin.from)},
                      {"to", rounded(bin.to)},
                      {"count", bin.count},
                      {"mean", rounded(bin.mean_probability)},
                      {"correct", rounded(bin.correct_share)}});
    ordered_json figures = ordered_json::object();
    for (const auto& [name, value] : file.figures) figures[name] = rounded(value, 6);
    out.push_back({{"file", file.name}, {"figures", figures}, {"reliability", bins}});
  }
  return out;
}

void addPaths(const RunData& run, ordered_json& out) {
  out["path"] = pathJson(run.path);
  out["live_path"] = pathJson(run.live_path);
  out["truth_path"] = pathJson(run.truth_path);
  out["least_gap_s"] = rounded(run.least_gap_s, 1);
  out["gaps"] = ordered_json::array();
  for (const auto& [from, to] : run.gaps) out["gaps"].push_back({rounded(from), rounded(to)});
  out["hindsight_m"] = seriesJson(run.hindsight_m);
  out["truth_is_of_camera"] = run.truth_is_of_camera;
  out["final_errors"] = errorsJson(run.final_errors);
  out["live_errors"] = errorsJson(run.live_errors);
  out["closures"] = ordered_json::array();
  for (const auto& c : run.closures)
    out["closures"].push_back({{"ids", {c.id_a, c.id_b}},
                               {"t", roundedList(std::array{c.t_a, c.t_b}, 2)},
                               {"a", roundedList(c.a, 2)},
                               {"b", roundedList(c.b, 2)},
                               {"kind", c.kind},
                               {"off_m", rounded(c.off_m)},
                               {"off_rad", rounded(c.off_rad)},
                               {"off_sigmas", rounded(c.off_sigmas, 2)}});
}

// null: the run did not say.
void addTroubles(const RunData& run, ordered_json& out) {
  out["lost"] = out["findings"] = nullptr;
  if (run.lost) out["lost"] = ordered_json::array();
  if (run.findings) out["findings"] = ordered_json::array();
  for (const auto& span : run.lost.value_or(std::vector<LostRow>()))
    out["lost"].push_back({{"sensor", span.sensor},
                           {"from", rounded(span.from, 2)},
                           {"to", rounded(span.to, 2)},
                           {"records", span.records},
                           {"why", span.why}});
  for (const auto& found : run.findings.value_or(std::vector<FindingRow>()))
    out["findings"].push_back(
        {{"severity", found.severity}, {"place", found.place}, {"what", found.what}, {"hint", found.hint}});
}

void addSummary(const RunData& run, ordered_json& out) {
  out["counts"] = run.counts;
  out["reasons"] = run.reasons;
  out["records_used"] = run.records_used;
  out["records_skipped"] = run.records_skipped;
  out["warnings"] = run.run_warnings;
  out["stages"] = ordered_json::array();
  for (const auto& s : run.stages)
    out["stages"].push_back({{"name", s.name},
                             {"calls", s.calls},
                             {"mean_ms", rounded(s.mean_ms)},
                             {"max_ms", rounded(s.max_ms)},
                             {"total_ms", rounded(s.total_ms, 3)},
                             {"cpu_ms", rounded(s.cpu_ms, 3)}});
  out["record_ms"] = seriesJson(run.record_ms);
  out["memory_mb"] = seriesJson(run.memory_mb);
  out["peak_memory_mb"] = rounded(run.peak_memory_mb, 1);
  out["wall_s"] = rounded(run.wall_s, 1);
}

ordered_json runJson(const RunData& run) {
  ordered_json out{{"name", run.name},
                   {"recording", run.recording},
                   {"input", run.input},
                   {"version", run.version},
                   {"command", run.command},
                   {"interrupted", run.interrupted},
                   {"start", rounded(run.start_t, 3)},
                   {"duration", rounded(run.duration_s, 3)},
                   {"length_m", rounded(run.length_m, 3)},
                   {"poses", run.poses}};
  addPaths(run, out);
  addSummary(run, out);
  addTroubles(run, out);
  out["grid"] = gridJson(run.grid);
  out["objects"] = ordered_json::array();
  for (const auto& object : run.objects) out["objects"].push_back(objectJson(object));
  out["colours"] = run.colours;
  out["config"] = configJson(run.config);
  out["evaluations"] = evaluationsJson(run.evaluations);
  out["missing"] = run.missing;
  return out;
}

}  // namespace

std::string dataJson(const std::vector<RunData>& runs) {
  ordered_json all{{"runs", ordered_json::array()}};
  for (const auto& run : runs) all["runs"].push_back(runJson(run));
  const std::string text = all.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size() + text.size() / 64);
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";  // only strings hold one
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace roomgraph
