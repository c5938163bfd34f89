// SPDX-License-Identifier: BSD-3-Clause
// Text tables of trajectory, relation and object errors.
#include "roomgraph/evaluation/report.h"

#include <cmath>

#include "text_format.h"

namespace roomgraph {
namespace {

std::string statisticsRow(const char* name, const char* unit, const ErrorStatistics& s) {
  if (s.count == 0) return format("%-22s %-4s %10s\n", name, unit, "none");
  return format("%-22s %-4s %10.4f %10.4f %10.4f %10.4f %10.4f %8d\n", name, unit, s.rmse, s.mean, s.median,
                s.std, s.max, s.count);
}

std::string statisticsHead() {
  return format("%-22s %-4s %10s %10s %10s %10s %10s %8s\n", "", "", "rmse", "mean", "median", "std", "max",
                "count");
}

std::string figuresRow(const std::string& name, const ObjectFigures& f) {
  const bool hit = f.correct > 0;
  return format("%-14s %7d %7d %7d %7d %7d %8s %8s %8s %9s %9s %8s %8s %8s\n", name.c_str(), f.correct,
                f.false_alarms, f.duplicates, f.missed, f.uncounted,
                cell(f.precision, f.correct + f.false_alarms > 0, "%.3f").c_str(),
                cell(f.recall, f.correct + f.missed > 0, "%.3f").c_str(),
                cell(f.f1, f.correct + f.missed + f.false_alarms > 0, "%.3f").c_str(),
                cell(f.position_m.mean, hit, "%.3f").c_str(), cell(f.position_m.median, hit, "%.3f").c_str(),
                cell(f.yaw_deg.mean, f.yaw_deg.count > 0, "%.1f").c_str(),
                cell(f.size_m.mean, hit, "%.3f").c_str(), cell(f.iou3d_mean, hit, "%.3f").c_str());
}

}  // namespace

std::string toTable(const TrajectoryErrors& e) {
  return statisticsHead() + statisticsRow("ATE", "m", e.ate_m) +
         statisticsRow("RPE translation", "m", e.rpe_trans_m) +
         statisticsRow("RPE rotation", "deg", e.rpe_rot_deg) +
         format("pairs %d of %d estimated and %d true poses; %.1f %% of the truth's time span covered\n",
                e.pairs, e.estimated_poses, e.truth_poses, 100 * e.coverage);
}

std::string toTable(const RelationErrors& e) {
  return statisticsHead() + statisticsRow("translation", "m", e.trans_m) +
         statisticsRow("rotation", "deg", e.rot_deg) +
         format("squared: translation %.6f +- %.6f m^2, rotation %.4f +- %.4f deg^2\n",
                e.trans_m.squared_mean, e.trans_m.squared_std, e.rot_deg.squared_mean,
                e.rot_deg.squared_std) +
         format("relations used %d, without estimate %d\n", e.used, e.missing);
}

std::string toTable(const ObjectErrors& e) {
  std::string text = format("%-14s %7s %7s %7s %7s %7s %8s %8s %8s %9s %9s %8s %8s %8s\n", "class", "correct",
                            "false", "double", "missed", "uncntd", "precis.", "recall", "F1", "pos mean",
                            "pos med.", "yaw deg", "size m", "IoU 3D");
  for (const auto& [name, figures] : e.per_class) text += figuresRow(name, figures);
  text += figuresRow("all", e.all);
  for (const auto& v : e.verdicts)
    if (v.verdict != Verdict::kCorrect && v.verdict != Verdict::kIgnored)
      text += "landmark " + std::to_string(v.landmark) + " (" + v.class_name + "): " + toString(v.verdict) +
              (v.truth >= 0 ? format(", %.2f m from true object %d", v.distance_m, v.truth) : "") + "\n";
  for (const int id : e.missed) text += "true object " + std::to_string(id) + ": missed\n";
  return text;
}

}  // namespace roomgraph
