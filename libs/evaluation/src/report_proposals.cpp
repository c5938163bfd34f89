// SPDX-License-Identifier: BSD-3-Clause
// Rows and JSON keys of the proposal benchmark.
#include "roomgraph/evaluation/report_proposals.h"

#include "text_format.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

std::string row(const std::string& name, const ProposalFigures& f) {
  return format("%-14s %6d %6d %8.3f %8.3f %8.1f %8.1f %7.2f %7.2f %7.2f %8.3f %8.3f %8.3f %7.2f %7.2f\n",
                name.c_str(), f.detections, f.without_proposal, f.center_top_m.median, f.center_best_m.median,
                f.yaw_top_deg.median, f.yaw_best_deg.median, f.iou3d_top_median, f.iou3d_best_median,
                f.share_good, f.center_top_m.p95, f.away_mean_m, f.sigma_m.median, f.nees_mean,
                f.nees_median);
}

ordered_json figuresJson(const ProposalFigures& f) {
  const bool any = f.detections > f.without_proposal;
  return {{"detections", f.detections},
          {"without_proposal", f.without_proposal},
          {"center_top_median_m", orNull(f.center_top_m.median, any)},
          {"center_best_median_m", orNull(f.center_best_m.median, any)},
          {"center_top_p95_m", orNull(f.center_top_m.p95, any)},
          {"yaw_top_median_deg", orNull(f.yaw_top_deg.median, any)},
          {"yaw_best_median_deg", orNull(f.yaw_best_deg.median, any)},
          {"iou3d_top_median", orNull(f.iou3d_top_median, any)},
          {"iou3d_best_median", orNull(f.iou3d_best_median, any)},
          {"share_iou3d_above_0.4", f.share_good},
          {"away_mean_m", orNull(f.away_mean_m, any)},
          {"left_mean_m", orNull(f.left_mean_m, any)},
          {"nees_mean", orNull(f.nees_mean, any)},
          {"nees_median", orNull(f.nees_median, any)}};
}

}  // namespace

std::string toTable(const ProposalBenchmark& b) {
  std::string text = format("%-14s %6s %6s %8s %8s %8s %8s %7s %7s %7s %8s %8s %8s %7s %7s\n", "class",
                            "boxes", "none", "pos top", "best", "yaw top", "best", "IoU top", "best",
                            "IoU>.4", "pos 95%", "away m", "sigma m", "NEES", "median");
  for (const auto& [name, figures] : b.per_class) text += row(name, figures);
  const GroundFigures& g = b.ground;
  text +=
      format("ground: %d of %d frames; angle median %.3f deg, 95 %% %.3f; height median %.4f m, 95 %% %.4f; ",
             g.found, g.frames, g.angle_deg.median, g.angle_deg.p95, g.height_m.median, g.height_m.p95);
  text +=
      format("within 1 deg and 2 cm %.3f; wrong %d; NEES %.2f (of 3)\n", g.share_good, g.wrong, g.nees_mean);
  for (const auto& [boxes, cpu] : b.cpu_ms)
    text += format("CPU with %2d boxes: median %6.2f ms, 95 %% %6.2f, max %6.2f (%d frames)\n", boxes,
                   cpu.median, cpu.p95, cpu.max, cpu.count);
  return text;
}

std::string toJson(const ProposalBenchmark& b) {
  ordered_json out;
  out["per_class"] = ordered_json::object();
  for (const auto& [name, figures] : b.per_class) out["per_class"][name] = figuresJson(figures);
  const GroundFigures& g = b.ground;
  out["ground"] = {{"frames", g.frames},
                   {"found", g.found},
                   {"angle_median_deg", orNull(g.angle_deg.median, g.found > 0)},
                   {"angle_p95_deg", orNull(g.angle_deg.p95, g.found > 0)},
                   {"height_median_m", orNull(g.height_m.median, g.found > 0)},
                   {"height_p95_m", orNull(g.height_m.p95, g.found > 0)},
                   {"share_good", orNull(g.share_good, g.found > 0)},
                   {"wrong", g.wrong},
                   {"nees_mean", orNull(g.nees_mean, g.found > 0)}};
  out["cpu_ms"] = ordered_json::array();
  for (const auto& [boxes, cpu] : b.cpu_ms)
    out["cpu_ms"].push_back({{"boxes", boxes},
                             {"frames", cpu.count},
                             {"median", cpu.median},
                             {"p95", cpu.p95},
                             {"max", cpu.max}});
  return out.dump(2) + "\n";
}

std::string toJsonLine(const ProposalCase& c) {
  ordered_json out = {{"timestamp", c.t},
                      {"object", c.object},
                      {"class", c.class_name},
                      {"bbox", {c.box.u_min, c.box.v_min, c.box.u_max, c.box.v_max}}};
  if (!c.proposals.empty()) {
    const Proposal& top = c.proposals.front();
    const ProposalError error = errorOf(top, c);
    out["proposal"] = {{"source", top.source},
                       {"score", top.score},
                       {"has_yaw", top.has_yaw},
                       {"center_error_m", {error.center.x(), error.center.y()}},
                       {"yaw_error_deg", error.yaw_deg},
                       {"size_error_m", {error.size.x(), error.size.y(), error.size.z()}},
                       {"iou3d", error.iou3d},
                       {"range_m", error.range_m},
                       {"error_in_view_m", {error.in_view.x(), error.in_view.y()}},
                       {"error_in_object_m", {error.in_object.x(), error.in_object.y()}},
                       {"nees", error.nees},
                       {"sigma_in_view_m", {error.sigma_in_view.x(), error.sigma_in_view.y()}},
                       {"reasons", top.reasons}};
  }
  return out.dump() + "\n";
}

}  // namespace roomgraph
