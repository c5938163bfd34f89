// SPDX-License-Identifier: BSD-3-Clause
// JSON of trajectory, relation, object and association errors.
#include "roomgraph/evaluation/report.h"
#include "text_format.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

void put(ordered_json& out, const std::string& prefix, const std::string& unit, const ErrorStatistics& s) {
  const bool any = s.count > 0;
  out[prefix + "_rmse_" + unit] = orNull(s.rmse, any);
  out[prefix + "_mean_" + unit] = orNull(s.mean, any);
  out[prefix + "_median_" + unit] = orNull(s.median, any);
  out[prefix + "_std_" + unit] = orNull(s.std, any);
  out[prefix + "_max_" + unit] = orNull(s.max, any);
}

void putKuemmerle(ordered_json& out, const std::string& prefix, const std::string& unit,
                  const ErrorStatistics& s) {
  put(out, prefix + "_abs", unit, s);
  out[prefix + "_sqr_mean_" + unit + "2"] = orNull(s.squared_mean, s.count > 0);
  out[prefix + "_sqr_std_" + unit + "2"] = orNull(s.squared_std, s.count > 0);
}

ordered_json figures(const ObjectFigures& f) {
  ordered_json out;
  const bool hit = f.correct > 0;
  out["precision"] = orNull(f.precision, f.correct + f.false_alarms > 0);
  out["recall"] = orNull(f.recall, f.correct + f.missed > 0);
  out["f1"] = orNull(f.f1, f.correct + f.false_alarms + f.missed > 0);
  out["correct"] = f.correct;
  out["false_alarms"] = f.false_alarms;
  out["missed"] = f.missed;
  out["duplicates"] = f.duplicates;
  out["uncounted"] = f.uncounted;
  out["position_error_mean_m"] = orNull(f.position_m.mean, hit);
  out["position_error_median_m"] = orNull(f.position_m.median, hit);
  out["position_error_max_m"] = orNull(f.position_m.max, hit);
  out["yaw_error_mean_deg"] = orNull(f.yaw_deg.mean, f.yaw_deg.count > 0);
  out["yaw_error_median_deg"] = orNull(f.yaw_deg.median, f.yaw_deg.count > 0);
  out["yaw_pairs"] = f.yaw_deg.count;
  out["size_error_mean_m"] = orNull(f.size_m.mean, hit);
  out["iou3d_mean"] = orNull(f.iou3d_mean, hit);
  out["position_nees_mean"] = orNull(f.nees.mean, f.nees.count > 0);
  out["position_nees_median"] = orNull(f.nees.median, f.nees.count > 0);
  return out;
}

ordered_json objectsJson(const ObjectErrors& e) {
  ordered_json out = figures(e.all);
  out["per_class"] = ordered_json::object();
  for (const auto& [name, f] : e.per_class) out["per_class"][name] = figures(f);
  out["landmarks"] = ordered_json::array();
  for (const auto& v : e.verdicts) {
    const bool matched = v.truth >= 0;
    out["landmarks"].push_back({{"id", v.landmark},
                                {"class", v.class_name},
                                {"verdict", toString(v.verdict)},
                                {"truth", matched ? ordered_json(v.truth) : ordered_json(nullptr)},
                                {"distance_m", orNull(v.distance_m, matched)},
                                {"yaw_error_deg", orNull(v.yaw_error_deg, v.yaw_error_deg >= 0)},
                                {"iou3d", orNull(v.iou3d, v.verdict == Verdict::kCorrect)},
                                {"position_nees", orNull(v.nees, v.nees >= 0)}});
  }
  out["missed_objects"] = e.missed;
  return out;
}

void putAssociations(ordered_json& out, const AssociationErrors& e) {
  out["association_accuracy"] = orNull(e.accuracy, e.attributed > 0);
  out["association_ece"] = orNull(e.ece, e.with_probability > 0);
  out["identity_switches"] = e.identity_switches;
  out["associations_attributed"] = e.attributed;
  out["associations_unattributed"] = e.unattributed;
  out["associations_correct"] = e.correct;
  out["associations_needless_new"] = e.needless_new;
  out["associations_wrong_landmark"] = e.wrong_landmark;
  out["associations_objects"] = e.objects;
  out["associations_landmarks"] = e.object_of_landmark.size();
  out["association_reliability"] = ordered_json::array();
  for (std::size_t i = 0; i < e.reliability.size(); ++i) {
    const auto& bin = e.reliability[i];
    const double width = 1.0 / static_cast<double>(e.reliability.size());
    out["association_reliability"].push_back(
        {{"from", static_cast<double>(i) * width},
         {"to", static_cast<double>(i + 1) * width},
         {"count", bin.count},
         {"mean_probability", orNull(bin.mean_probability, bin.count > 0)},
         {"correct_share", orNull(bin.correct_share, bin.count > 0)}});
  }
}

}  // namespace

std::string toJson(const TrajectoryErrors& e) {
  ordered_json out;
  put(out, "ate", "m", e.ate_m);
  put(out, "rpe_trans", "m", e.rpe_trans_m);
  put(out, "rpe_rot", "deg", e.rpe_rot_deg);
  out["rpe_pairs"] = e.rpe_trans_m.count;
  out["pairs"] = e.pairs;
  out["truth_poses"] = e.truth_poses;
  out["estimated_poses"] = e.estimated_poses;
  out["coverage"] = e.coverage;
  out["matched_share"] = e.matched_share;
  return out.dump(2) + "\n";
}

std::string toJson(const RelationErrors& e) {
  ordered_json out;
  putKuemmerle(out, "trans", "m", e.trans_m);
  putKuemmerle(out, "rot", "deg", e.rot_deg);
  out["used"] = e.used;
  out["missing"] = e.missing;
  return out.dump(2) + "\n";
}

std::string toJson(const ObjectErrors& e) {
  return objectsJson(e).dump(2) + "\n";
}

std::string toJson(const ObjectErrors& objects, const AssociationErrors& associations) {
  ordered_json out = objectsJson(objects);
  putAssociations(out, associations);
  return out.dump(2) + "\n";
}

}  // namespace roomgraph
