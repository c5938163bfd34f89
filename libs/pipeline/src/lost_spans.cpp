// SPDX-License-Identifier: BSD-3-Clause
// Runs of lost records, gaps between records.
#include "roomgraph/pipeline/lost_spans.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace roomgraph {
namespace {

constexpr double kLeastSilence_s = 1, kSilenceInSpacings = 10;

// "not tracked: too few matches" -> "too few matches".
std::string causeIn(const std::string& note) {
  const auto colon = note.find(": ");
  return colon == std::string::npos ? note : note.substr(colon + 2);
}

double medianSpacing(const std::vector<double>& times) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < times.size(); ++i) spacing.push_back(times[i] - times[i - 1]);
  if (spacing.empty()) return 0;
  const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
  std::nth_element(spacing.begin(), middle, spacing.end());
  return *middle;
}

}  // namespace

void LostSpans::onStep(const StepReport& report) {
  const bool stamped =
      report.kind != StepReport::Kind::kOther || report.t != 0;  // left out records have no time
  if (!stamped) return;
  if (!begun_) first_t_ = report.t;
  begun_ = true;
  last_t_ = std::max(last_t_, report.t);
  if (report.kind == StepReport::Kind::kFrame) seen_["camera"].push_back({report.t, causeIn(report.note)});
  if (report.kind == StepReport::Kind::kScan) seen_["lidar"].push_back({report.t, causeIn(report.note)});
}

std::vector<LostSpan> LostSpans::spans() const {
  std::vector<LostSpan> out;
  for (const auto& [sensor, records] : seen_) {
    std::vector<double> times;
    for (std::size_t i = 0; i < records.size(); ++i) {
      times.push_back(records[i].t);
      if (records[i].why.empty()) continue;
      const double to = i + 1 < records.size() ? records[i + 1].t : records[i].t;
      const bool goes_on = i > 0 && records[i - 1].why == records[i].why;
      if (!goes_on) out.push_back({sensor, records[i].t, to, 0, records[i].why});
      out.back().to = to;
      ++out.back().records;
    }
    const double least_s = std::max(kLeastSilence_s, kSilenceInSpacings * medianSpacing(times));
    times.insert(times.begin(), first_t_);
    times.push_back(last_t_);
    for (std::size_t i = 1; i < times.size(); ++i)
      if (times[i] - times[i - 1] > least_s) out.push_back({sensor, times[i - 1], times[i], 0, "no record"});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const LostSpan& a, const LostSpan& b) { return a.from < b.from; });
  return out;
}

std::string LostSpans::text() const {
  std::string out;
  for (const auto& span : spans()) {
    const nlohmann::ordered_json line{{"sensor", span.sensor},
                                      {"from", span.from},
                                      {"to", span.to},
                                      {"records", span.records},
                                      {"why", span.why}};
    out += line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  }
  return out;
}

}  // namespace roomgraph
