// SPDX-License-Identifier: BSD-3-Clause
// Optimal matching per class, verdict on every landmark, and the figures from them.
#include "roomgraph/evaluation/object_error.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "assignment.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr const char* kPerson = "person";
constexpr const char* kOtherClass = "other";
using Objects = std::vector<EvaluatedObject>;

double groundDistance(const EvaluatedObject& a, const EvaluatedObject& b) {
  return (a.position - b.position).head<2>().norm();
}

Objects moved(Objects landmarks, const Pose2& truth_from_map) {
  for (auto& landmark : landmarks) {
    landmark.position.head<2>() = truth_from_map * Eigen::Vector2d(landmark.position.head<2>());
    landmark.yaw = wrapAngle(landmark.yaw + truth_from_map.yaw);
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(truth_from_map.yaw).toRotationMatrix();
    if (auto& covariance = landmark.place_covariance) *covariance = turn * *covariance * turn.transpose();
  }
  return landmarks;
}

double iou3dOf(const EvaluatedObject& a, const EvaluatedObject& b, ShapeKind kind) {
  const auto shape = [&](const EvaluatedObject& o) { return ObjectShape{kind, o.width, o.depth, o.height}; };
  const auto pose = [](const EvaluatedObject& o) {
    return poseFromYpr(o.position.x(), o.position.y(), o.position.z(), o.has_yaw ? o.yaw : 0, 0, 0);
  };
  return iou3d(shape(a), pose(a), shape(b), pose(b));
}

void compare(const EvaluatedObject& truth, const EvaluatedObject& landmark, const ClassRule& rule,
             LandmarkVerdict& out) {
  out.truth = truth.id;
  out.distance_m = groundDistance(truth, landmark);
  out.size_error_m = (std::abs(truth.width - landmark.width) + std::abs(truth.depth - landmark.depth) +
                      std::abs(truth.height - landmark.height)) /
                     3;
  out.iou3d = iou3dOf(truth, landmark, rule.shape);
  const Eigen::Vector2d error = (landmark.position - truth.position).head<2>();
  if (landmark.place_covariance && landmark.place_covariance->determinant() > 0)
    out.nees = error.dot(landmark.place_covariance->inverse() * error);
  if (rule.symmetry > 0 && truth.has_yaw && landmark.has_yaw)
    out.yaw_error_deg =
        std::abs(wrapAngle((landmark.yaw - truth.yaw) * rule.symmetry)) / rule.symmetry * kDegreesPerRadian;
}

// State of one comparison: the landmarks in the truth's world and the verdict on each.
class Comparison {
 public:
  Comparison(const Objects& truth, const Objects& landmarks, const ObjectOptions& options)
      : truth_(truth), landmarks_(moved(landmarks, options.truth_from_map)), options_(options) {
    out_.verdicts.resize(landmarks_.size());
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      out_.verdicts[i].landmark = landmarks_[i].id;
      out_.verdicts[i].class_name = landmarks_[i].class_name;
      if (!evaluated(landmarks_[i])) out_.verdicts[i].verdict = Verdict::kIgnored;
    }
  }

  ObjectErrors run() {
    for (const auto& [name, rule] : options_.classes)
      if (name != kPerson && name != kOtherClass) matchClass(name, rule);
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      auto& verdict = out_.verdicts[i];
      if (verdict.verdict == Verdict::kFalseAlarm) explain(landmarks_[i], verdict);
    }
    return std::move(out_);
  }

 private:
  bool evaluated(const EvaluatedObject& landmark) const {
    const bool known = options_.classes.count(landmark.class_name) > 0 || landmark.class_name == kPerson;
    return known && landmark.existence >= options_.min_existence;
  }
  bool counts(const EvaluatedObject& truth) const {
    return !options_.seen || options_.seen->count(truth.id) > 0;
  }

  void matchClass(const std::string& name, const ClassRule& rule) {
    std::vector<std::size_t> rows, columns;
    for (std::size_t i = 0; i < truth_.size(); ++i)
      if (truth_[i].class_name == name) rows.push_back(i);
    for (std::size_t j = 0; j < landmarks_.size(); ++j)
      if (landmarks_[j].class_name == name && evaluated(landmarks_[j])) columns.push_back(j);
    Eigen::MatrixXd costs(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < columns.size(); ++j)
        costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            groundDistance(truth_[rows[i]], landmarks_[columns[j]]);
    const auto column_of = assignWithinGate(costs, options_.gate_m);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const EvaluatedObject& object = truth_[rows[i]];
      if (column_of[i] >= 0) {
        const std::size_t j = columns[static_cast<std::size_t>(column_of[i])];
        out_.verdicts[j].verdict = counts(object) ? Verdict::kCorrect : Verdict::kUncounted;
        compare(object, landmarks_[j], rule, out_.verdicts[j]);
      } else if (counts(object)) {
        out_.missed.push_back(object.id);
      }
    }
  }

  // Verdict on an unmatched landmark by the nearest true object within the gate.
  void explain(const EvaluatedObject& landmark, LandmarkVerdict& verdict) const {
    double nearest = options_.gate_m;
    for (const auto& object : truth_) {
      const bool same_class = object.class_name == landmark.class_name && landmark.class_name != kPerson;
      const bool forgiven =
          isForgiven(options_.forgiven_kinds, landmark.class_name, object.class_name, object.kind);
      if (!same_class && !forgiven) continue;
      const double distance = groundDistance(object, landmark);
      if (distance > nearest) continue;
      nearest = distance;
      verdict.truth = object.id;
      verdict.distance_m = distance;
      // Of the same class, yet unmatched: another landmark is matched with the object.
      verdict.verdict = same_class && counts(object) ? Verdict::kDuplicate : Verdict::kUncounted;
    }
  }

  const Objects& truth_;
  const Objects landmarks_;
  const ObjectOptions& options_;
  ObjectErrors out_;
};

ObjectFigures figuresOf(const std::vector<LandmarkVerdict>& verdicts, int missed) {
  ObjectFigures out;
  out.missed = missed;
  std::vector<double> position, yaw, size, nees;
  for (const auto& v : verdicts) {
    out.uncounted += v.verdict == Verdict::kUncounted;
    out.duplicates += v.verdict == Verdict::kDuplicate;
    out.false_alarms += v.verdict == Verdict::kDuplicate || v.verdict == Verdict::kFalseAlarm;
    if (v.verdict != Verdict::kCorrect) continue;
    ++out.correct;
    position.push_back(v.distance_m);
    size.push_back(v.size_error_m);
    if (v.nees >= 0) nees.push_back(v.nees);
    if (v.yaw_error_deg >= 0) yaw.push_back(v.yaw_error_deg);
    out.iou3d_mean += v.iou3d;
  }
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0.0; };
  out.iou3d_mean = share(out.iou3d_mean, out.correct);
  out.precision = share(out.correct, out.correct + out.false_alarms);
  out.recall = share(out.correct, out.correct + out.missed);
  out.f1 = share(2 * out.correct, 2 * out.correct + out.false_alarms + out.missed);
  out.position_m = summarize(position);
  out.yaw_deg = summarize(yaw);
  out.size_m = summarize(size);
  out.nees = summarize(nees);
  return out;
}

}  // namespace

std::string toString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kCorrect:
      return "correct";
    case Verdict::kUncounted:
      return "uncounted";
    case Verdict::kDuplicate:
      return "duplicate";
    case Verdict::kFalseAlarm:
      return "false alarm";
    case Verdict::kIgnored:
      return "ignored";
  }
  throw std::invalid_argument("unknown verdict");
}

std::map<std::string, ClassRule> classRules(const ObjectDatabase& database) {
  std::map<std::string, ClassRule> rules;
  for (const auto& model : database.models())
    if (model.landmark) rules[model.class_name] = {shapeKindFromString(model.shape), model.symmetry};
  return rules;
}

ObjectErrors evaluateObjects(const std::vector<EvaluatedObject>& truth,
                             const std::vector<EvaluatedObject>& landmarks, const ObjectOptions& options) {
  ObjectErrors out = Comparison(truth, landmarks, options).run();
  std::map<std::string, std::vector<LandmarkVerdict>> verdicts;
  std::map<std::string, int> missed;
  for (const auto& v : out.verdicts)
    if (v.verdict != Verdict::kIgnored) verdicts[v.class_name].push_back(v);
  for (const auto& object : truth)
    for (const int id : out.missed)
      if (object.id == id) ++missed[object.class_name];
  for (const auto& [name, rule] : options.classes) verdicts[name];
  for (const auto& [name, list] : verdicts) out.per_class[name] = figuresOf(list, missed[name]);
  out.all = figuresOf(out.verdicts, static_cast<int>(out.missed.size()));
  return out;
}

}  // namespace roomgraph
