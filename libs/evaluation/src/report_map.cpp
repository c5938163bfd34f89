// SPDX-License-Identifier: BSD-3-Clause
// Table and JSON of the errors of an occupancy map.
#include "roomgraph/evaluation/report.h"
#include "text_format.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

std::string row(const char* name, const ErrorStatistics& s) {
  const bool any = s.count > 0;
  return format("%-34s %8s %8s %8s %8s %8d\n", name, cell(s.mean, any, "%.4f").c_str(),
                cell(s.median, any, "%.4f").c_str(), cell(s.p95, any, "%.4f").c_str(),
                cell(s.max, any, "%.4f").c_str(), s.count);
}

void put(ordered_json& out, const std::string& prefix, const ErrorStatistics& s) {
  out[prefix + "_mean_m"] = orNull(s.mean, s.count > 0);
  out[prefix + "_median_m"] = orNull(s.median, s.count > 0);
  out[prefix + "_p95_m"] = orNull(s.p95, s.count > 0);
  out[prefix + "_max_m"] = orNull(s.max, s.count > 0);
}

}  // namespace

std::string toTable(const MapErrors& e) {
  const bool any = e.known_in_both > 0;
  return format("occupied: precision %s (of %d cells), recall %s (of %d), F1 %s\n",
                cell(e.precision, e.checked_occupied > 0, "%.4f").c_str(), e.checked_occupied,
                cell(e.recall, e.expected_occupied > 0, "%.4f").c_str(), e.expected_occupied,
                cell(e.f1, e.checked_occupied + e.expected_occupied > 0, "%.4f").c_str()) +
         format("free: agreement %s, precision %s; same state %s of %d cells known in both; unknown %.4f\n",
                cell(e.free_agreement, any, "%.4f").c_str(), cell(e.free_precision, any, "%.4f").c_str(),
                cell(e.agreement, any, "%.4f").c_str(), e.known_in_both, e.unknown_share) +
         format("%-34s %8s %8s %8s %8s %8s\n", "distance of occupied cells, m", "mean", "median", "95 %",
                "max", "cells") +
         row("estimated to nearest true", e.to_truth_m) + row("true to nearest estimated", e.to_map_m);
}

std::string toJson(const MapErrors& e) {
  const bool any = e.known_in_both > 0;
  ordered_json out;
  out["precision"] = orNull(e.precision, e.checked_occupied > 0);
  out["recall"] = orNull(e.recall, e.expected_occupied > 0);
  out["f1"] = orNull(e.f1, e.checked_occupied + e.expected_occupied > 0);
  out["free_agreement"] = orNull(e.free_agreement, any);
  out["free_precision"] = orNull(e.free_precision, any);
  out["agreement"] = orNull(e.agreement, any);
  out["unknown_share"] = e.unknown_share;
  put(out, "wall_distance", e.to_truth_m);
  put(out, "wall_distance_reverse", e.to_map_m);
  out["known_in_both"] = e.known_in_both;
  out["estimated_occupied"] = e.estimated_occupied;
  out["true_occupied"] = e.true_occupied;
  return out.dump(2) + "\n";
}

}  // namespace roomgraph
