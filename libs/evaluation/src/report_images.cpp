// SPDX-License-Identifier: BSD-3-Clause
// Tables and JSON of what is compared per image: detections and associations.
#include "roomgraph/evaluation/report.h"
#include "text_format.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

std::string row(const std::string& name, const DetectionFigures& f) {
  const bool truth = f.correct + f.missed > 0;
  return format("%-14s %7d %7d %7d %7d %8s %8s %8s %8s\n", name.c_str(), f.correct, f.false_alarms, f.missed,
                f.ignored, cell(f.precision, f.correct + f.false_alarms > 0, "%.3f").c_str(),
                cell(f.recall, truth, "%.3f").c_str(),
                cell(f.f1, f.correct + f.false_alarms + f.missed > 0, "%.3f").c_str(),
                cell(f.ap, truth, "%.3f").c_str());
}

ordered_json figures(const DetectionFigures& f) {
  const bool truth = f.correct + f.missed > 0;
  return {{"precision", orNull(f.precision, f.correct + f.false_alarms > 0)},
          {"recall", orNull(f.recall, truth)},
          {"f1", orNull(f.f1, f.correct + f.false_alarms + f.missed > 0)},
          {"ap", orNull(f.ap, truth)},
          {"correct", f.correct},
          {"false_alarms", f.false_alarms},
          {"missed", f.missed},
          {"ignored", f.ignored}};
}

}  // namespace

std::string toTable(const DetectionErrors& e) {
  std::string text = format("%-14s %7s %7s %7s %7s %8s %8s %8s %8s\n", "class", "correct", "false", "missed",
                            "ignored", "precis.", "recall", "F1", "AP");
  for (const auto& [name, f] : e.per_class) text += row(name, f);
  return text + row("all, mean AP", e.all) +
         format("frames compared %d, without truth %d; true frames the detector did not look at %d\n",
                e.frames, e.frames_without_truth, e.frames_without_detector);
}

std::string toJson(const DetectionErrors& e) {
  ordered_json out = figures(e.all);
  out["mean"] = {{"precision", orNull(e.mean_precision, e.all.correct + e.all.false_alarms > 0)},
                 {"recall", orNull(e.mean_recall, e.all.correct + e.all.missed > 0)},
                 {"ap", out["ap"]}};
  out["frames"] = e.frames;
  out["frames_without_truth"] = e.frames_without_truth;
  out["frames_without_detector"] = e.frames_without_detector;
  out["per_class"] = ordered_json::object();
  for (const auto& [name, f] : e.per_class) out["per_class"][name] = figures(f);
  return out.dump(2) + "\n";
}

std::string toTable(const AssociationErrors& e) {
  std::string text =
      format(
          "associations: accuracy %s (%d of %d; needless new %d, wrong landmark %d), of no true object %d\n",
          cell(e.accuracy, e.attributed > 0, "%.4f").c_str(), e.correct, e.attributed, e.needless_new,
          e.wrong_landmark, e.unattributed) +
      format("landmarks of %d true objects %d, identity switches %d, expected calibration error %s\n",
             e.objects, static_cast<int>(e.object_of_landmark.size()), e.identity_switches,
             cell(e.ece, e.with_probability > 0, "%.4f").c_str()) +
      format("%-12s %8s %8s %8s\n", "probability", "count", "mean p", "correct");
  for (std::size_t i = 0; i < e.reliability.size(); ++i) {
    const auto& bin = e.reliability[i];
    if (bin.count == 0) continue;
    text += format("%.1f .. %.1f   %8d %8.3f %8.3f\n", static_cast<double>(i) / 10,
                   static_cast<double>(i + 1) / 10, bin.count, bin.mean_probability, bin.correct_share);
  }
  return text;
}

}  // namespace roomgraph
