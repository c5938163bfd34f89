// SPDX-License-Identifier: BSD-3-Clause
// Landmarks against true objects: precision, recall, and errors of position, yaw, size and 3D IoU.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "roomgraph/evaluation/class_rule.h"
#include "roomgraph/evaluation/forgiven_kinds.h"
#include "roomgraph/evaluation/object_files.h"
#include "roomgraph/evaluation/statistics.h"

namespace roomgraph {

struct ObjectOptions {
  double gate_m = 0.5;       ///< largest distance of the centres on the ground
  double min_existence = 0;  ///< landmarks below are left out
  std::map<std::string, ClassRule> classes;  ///< those to evaluate
  ForgivenKinds forgiven_kinds = forgivenChairs();
  std::optional<std::set<int>> seen;  ///< ids that count for recall; nothing: all do
  Pose2 truth_from_map;               ///< moves the landmarks before they are compared
};

enum class Verdict {
  kCorrect,    ///< matched with a true object that counts
  kUncounted,  ///< on a true object that was seen too little to count, or on one of another kind
  kDuplicate,  ///< second landmark on an object that already has one; a false alarm
  kFalseAlarm,
  kIgnored,  ///< class is not evaluated, or existence too low
};
std::string toString(Verdict verdict);

/// Result of one landmark.
struct LandmarkVerdict {
  int landmark = -1;  ///< id
  std::string class_name;
  Verdict verdict = Verdict::kFalseAlarm;
  int truth = -1;             ///< id of the true object concerned, -1: none
  double distance_m = 0;      ///< to it, on the ground
  double yaw_error_deg = -1;  ///< modulo symmetry; -1: does not apply
  double size_error_m = 0;    ///< mean of |dw|, |dd|, |dh|
  double iou3d = 0;
  double nees = -1;  ///< squared distance by the covariance of its place; expected 2; -1: it has none
};

struct ObjectFigures {
  int correct = 0, false_alarms = 0, missed = 0, duplicates = 0, uncounted = 0;
  double precision = 0, recall = 0, f1 = 0;  ///< 0 where the denominator is 0
  ErrorStatistics position_m, yaw_deg, size_m;
  double iou3d_mean = 0;
  ErrorStatistics nees;  ///< of places, in units of their covariance: expected mean 2, median 1.39
};

struct ObjectErrors {
  ObjectFigures all;
  std::map<std::string, ObjectFigures> per_class;
  std::vector<LandmarkVerdict> verdicts;  ///< one per landmark, in the order of the map
  std::vector<int> missed;                ///< ids of true objects that count and have no landmark
};

/// Compares a map with the truth: optimal one-to-one matching per class within the gate. True objects of
/// class `person` or `other` never count; a landmark of class person is a false alarm; a landmark of a class without
/// rule is left out.
ObjectErrors evaluateObjects(const std::vector<EvaluatedObject>& truth,
                             const std::vector<EvaluatedObject>& landmarks,
                             const ObjectOptions& options = {});

}  // namespace roomgraph
