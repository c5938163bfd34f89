// SPDX-License-Identifier: BSD-3-Clause
// Object errors against values worked out by hand: matching, symmetry, distractors, visibility.
#include "roomgraph/evaluation/object_error.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "random_poses.h"
#include "usual_classes.h"

namespace roomgraph {
namespace {

using test::Random;
using Objects = std::vector<EvaluatedObject>;

EvaluatedObject object(int id, const std::string& name, double x, double y, double yaw = 0) {
  EvaluatedObject out;
  out.id = id;
  out.class_name = out.kind = name;
  out.position = {x, y, 0};
  out.yaw = yaw;
  out.width = out.depth = 0.6;
  out.height = 0.9;
  return out;
}

ObjectErrors errorsOf(const Objects& truth, const Objects& map, ObjectOptions options = {}) {
  options.classes = test::usualClasses();
  return evaluateObjects(truth, map, options);
}

EvaluatedObject distractor(int id, const std::string& kind, double x, double y) {
  auto out = object(id, "other", x, y);
  out.kind = kind;
  return out;
}

Verdict verdictOf(const ObjectErrors& errors, int landmark) {
  for (const auto& v : errors.verdicts)
    if (v.landmark == landmark) return v.verdict;
  throw std::out_of_range("no such landmark");
}

TEST(ObjectError, PerfectMap) {
  const Objects truth = {object(1, "swivel_chair", 0, 0), object(2, "sofa", 3, 1, 0.5),
                         object(3, "door", 5, 5, 1)};
  const auto errors = errorsOf(truth, truth);
  EXPECT_EQ(errors.all.correct, 3);
  EXPECT_EQ(errors.all.precision, 1);
  EXPECT_EQ(errors.all.recall, 1);
  EXPECT_EQ(errors.all.f1, 1);
  EXPECT_EQ(errors.all.position_m.max, 0);
  EXPECT_EQ(errors.all.yaw_deg.count, 2) << "chairs have no yaw";
  EXPECT_EQ(errors.all.yaw_deg.max, 0);
  EXPECT_NEAR(errors.all.iou3d_mean, 1, 1e-9);
}

TEST(ObjectError, HandComputedMixedMap) {
  const Objects truth = {object(1, "swivel_chair", 0, 0), object(2, "swivel_chair", 2, 0),
                         object(3, "swivel_chair", 4, 0), object(4, "sofa", 0, 5)};
  const Objects map = {object(10, "swivel_chair", 0.3, 0.4),  // on 1, exactly at the gate of .5 m
                       object(11, "swivel_chair", 2.1, 0),    // on 2
                       object(12, "swivel_chair", 2.2, 0),    // second one on 2
                       object(13, "sofa", 4, 0),              // wrong class
                       object(14, "swivel_chair", 9, 9)};     // nothing there
  const auto errors = errorsOf(truth, map);
  EXPECT_EQ(verdictOf(errors, 10), Verdict::kCorrect);
  EXPECT_EQ(verdictOf(errors, 11), Verdict::kCorrect);
  EXPECT_EQ(verdictOf(errors, 12), Verdict::kDuplicate);
  EXPECT_EQ(verdictOf(errors, 13), Verdict::kFalseAlarm);
  EXPECT_EQ(verdictOf(errors, 14), Verdict::kFalseAlarm);
  EXPECT_THAT(errors.missed, ::testing::ElementsAre(4, 3));
  EXPECT_NEAR(errors.all.precision, 2.0 / 5, 1e-12);
  EXPECT_NEAR(errors.all.recall, 2.0 / 4, 1e-12);
  EXPECT_NEAR(errors.all.f1, 4.0 / 9, 1e-12);
  EXPECT_EQ(errors.all.duplicates, 1);
  EXPECT_NEAR(errors.all.position_m.mean, 0.3, 1e-12);
  const auto& chairs = errors.per_class.at("swivel_chair");
  EXPECT_EQ(chairs.correct, 2);
  EXPECT_EQ(chairs.missed, 1);
  EXPECT_EQ(chairs.false_alarms, 2);
  EXPECT_EQ(errors.per_class.at("sofa").false_alarms, 1);
  EXPECT_EQ(errors.per_class.at("sofa").recall, 0);
  EXPECT_EQ(errors.per_class.at("door").correct, 0);
}

TEST(ObjectError, EmptySides) {
  const Objects some = {object(1, "sofa", 0, 0)};
  const auto nothing_mapped = errorsOf(some, {});
  EXPECT_EQ(nothing_mapped.all.missed, 1);
  EXPECT_EQ(nothing_mapped.all.recall, 0);
  EXPECT_EQ(nothing_mapped.all.precision, 0);
  const auto nothing_there = errorsOf({}, some);
  EXPECT_EQ(nothing_there.all.false_alarms, 1);
  EXPECT_EQ(nothing_there.all.precision, 0);
  EXPECT_EQ(errorsOf({}, {}).all.correct, 0);
}

TEST(ObjectError, OrderOfObjectsDoesNotMatter) {
  Random random(5);
  Objects truth, map;
  for (int i = 0; i < 12; ++i)
    truth.push_back(object(i, i % 2 ? "sofa" : "swivel_chair", random.uniform(0, 3), random.uniform(0, 3)));
  for (int i = 0; i < 12; ++i)
    map.push_back(
        object(100 + i, i % 3 ? "sofa" : "swivel_chair", random.uniform(0, 3), random.uniform(0, 3)));
  const auto reference = errorsOf(truth, map);
  for (int round = 0; round < 10; ++round) {
    std::rotate(truth.begin(), truth.begin() + 5, truth.end());
    std::reverse(map.begin(), map.begin() + 7);
    const auto errors = errorsOf(truth, map);
    EXPECT_EQ(errors.all.correct, reference.all.correct);
    EXPECT_NEAR(errors.all.position_m.mean, reference.all.position_m.mean, 1e-12);
    for (const auto& v : reference.verdicts) EXPECT_EQ(verdictOf(errors, v.landmark), v.verdict);
  }
}

TEST(ObjectError, MatchingIsOptimalNotGreedy) {
  const Objects truth = {object(1, "sofa", 0, 0), object(2, "sofa", 0.5, 0)};
  const Objects map = {object(10, "sofa", 0.3, 0), object(11, "sofa", 0.9, 0)};
  // Greedy takes 10-2 (.2 m) and leaves 1 and 11 (.9 m apart) alone.
  const auto errors = errorsOf(truth, map);
  EXPECT_EQ(errors.all.correct, 2);
  EXPECT_NEAR(errors.all.position_m.mean, 0.35, 1e-12);
}

TEST(ObjectError, YawModuloSymmetry) {
  const double degree = std::numbers::pi / 180;
  const auto yaw_error = [&](const std::string& name, double truth_deg, double map_deg) {
    const auto errors =
        errorsOf({object(1, name, 0, 0, truth_deg * degree)}, {object(2, name, 0, 0, map_deg * degree)});
    return errors.verdicts[0].yaw_error_deg;
  };
  EXPECT_NEAR(yaw_error("sofa", 10, 40), 30, 1e-9);
  EXPECT_NEAR(yaw_error("sofa", -170, 175), 15, 1e-9);
  EXPECT_NEAR(yaw_error("sofa", 0, 180), 180, 1e-9);
  EXPECT_NEAR(yaw_error("door", 0, 180), 0, 1e-9);
  EXPECT_NEAR(yaw_error("door", 10, 185), 5, 1e-9);
  EXPECT_NEAR(yaw_error("door", 0, 90), 90, 1e-9);
  EXPECT_EQ(yaw_error("swivel_chair", 0, 90), -1);
  auto unknown = object(2, "sofa", 0, 0);
  unknown.has_yaw = false;
  EXPECT_EQ(errorsOf({object(1, "sofa", 0, 0)}, {unknown}).all.yaw_deg.count, 0);
}

// Places drawn from their covariances, in a world that is turned: the mean is that of chi-squared with two
// degrees of freedom.
TEST(ObjectError, PlacesInUnitsOfTheirCovariance) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, 1);
  const Eigen::Matrix2d root{{0.05, 0}, {0.04, 0.01}};
  const Pose2 truth_from_map{3, -2, 0.7};
  constexpr int kObjects = 600;
  Objects truth, map;
  for (int i = 0; i < kObjects; ++i) {
    auto landmark = object(i, "sofa", 5.0 * (i % 60), 5.0 * (i / 60));
    const Eigen::Vector2d at =
        landmark.position.head<2>() + root * Eigen::Vector2d(normal(random), normal(random));
    truth.push_back(landmark);
    truth.back().position.head<2>() = truth_from_map * at;
    landmark.place_covariance = root * root.transpose();
    map.push_back(landmark);
  }
  ObjectOptions options;
  options.classes["sofa"] = {ShapeKind::kCuboid, 1};
  options.truth_from_map = truth_from_map;
  const auto errors = evaluateObjects(truth, map, options);
  ASSERT_EQ(errors.all.correct, kObjects);
  EXPECT_NEAR(errors.all.nees.mean, 2, 4 * 2 / std::sqrt(kObjects));
  EXPECT_NEAR(errors.all.nees.median, 1.386, 0.25);
  map.front().place_covariance.reset();
  EXPECT_EQ(evaluateObjects(truth, map, options).all.nees.count, kObjects - 1);
}

TEST(ObjectError, SizeErrorAndIou) {
  auto truth = object(1, "sofa", 0, 0), landmark = truth;
  truth.width = 2;
  truth.depth = 1;
  truth.height = 1;
  landmark.width = 1;
  landmark.depth = 1;
  landmark.height = 1;
  landmark.position.y() = 0.5;  // inside the true box: |y| <= 1, landmark covers [0, 1]
  const auto errors = errorsOf({truth}, {landmark});
  EXPECT_NEAR(errors.all.size_m.mean, 1.0 / 3, 1e-12);
  EXPECT_NEAR(errors.all.iou3d_mean, 0.5, 1e-9);
  EXPECT_NEAR(errors.all.position_m.mean, 0.5, 1e-12);
}

TEST(ObjectError, DistractorsAndPersons) {
  const Objects truth = {distractor(1, "wooden chair", 0, 0), distractor(2, "desk", 2, 0),
                         object(3, "person", 4, 0)};
  const Objects map = {object(10, "swivel_chair", 0.2, 0), object(11, "swivel_chair", 2, 0),
                       object(12, "swivel_chair", 4, 0),   object(13, "sofa", 0, 0),
                       object(14, "person", 4, 0),         object(15, "bookcase", 0, 0)};
  const auto errors = errorsOf(truth, map);
  EXPECT_EQ(verdictOf(errors, 10), Verdict::kUncounted) << "a chair of another kind";
  EXPECT_EQ(verdictOf(errors, 11), Verdict::kFalseAlarm);
  EXPECT_EQ(verdictOf(errors, 12), Verdict::kFalseAlarm) << "persons are no objects";
  EXPECT_EQ(verdictOf(errors, 13), Verdict::kFalseAlarm) << "a sofa is not a chair of another kind";
  EXPECT_EQ(verdictOf(errors, 14), Verdict::kFalseAlarm);
  EXPECT_EQ(verdictOf(errors, 15), Verdict::kIgnored) << "a class that the truth does not know";
  EXPECT_EQ(errors.all.missed, 0);
  EXPECT_EQ(errors.all.false_alarms, 4);
}

TEST(ObjectError, SeenObjectsOnlyCountForRecall) {
  const Objects truth = {object(1, "sofa", 0, 0), object(2, "sofa", 5, 0), object(3, "sofa", 10, 0)};
  ObjectOptions options;
  options.seen = std::set<int>{1};
  const auto errors = errorsOf(truth, {object(10, "sofa", 5, 0)}, options);
  EXPECT_EQ(errors.all.uncounted, 1);
  EXPECT_EQ(errors.all.false_alarms, 0);
  EXPECT_EQ(errors.all.correct, 0);
  EXPECT_THAT(errors.missed, ::testing::ElementsAre(1));
}

TEST(ObjectError, MapIsMovedIntoTheTruthsWorld) {
  const Objects truth = {object(1, "sofa", 3, 4, 1.2), object(2, "door", -1, 2, 0.4)};
  const Pose2 truth_from_map{2, -1, 0.8}, back = truth_from_map.inverse();
  Objects map = truth;
  for (auto& landmark : map) {
    landmark.position.head<2>() = back * Eigen::Vector2d(landmark.position.head<2>());
    landmark.yaw += back.yaw;
  }
  ObjectOptions options;
  EXPECT_EQ(errorsOf(truth, map, options).all.correct, 0);
  options.truth_from_map = truth_from_map;
  const auto errors = errorsOf(truth, map, options);
  EXPECT_EQ(errors.all.correct, 2);
  EXPECT_NEAR(errors.all.position_m.max, 0, 1e-12);
  EXPECT_NEAR(errors.all.yaw_deg.max, 0, 1e-9);
  EXPECT_NEAR(errors.all.iou3d_mean, 1, 1e-9);
}

TEST(ObjectError, ImprobableLandmarksAreSkippedOnRequest) {
  auto faint = object(10, "sofa", 9, 9);
  faint.existence = 0.2;
  ObjectOptions options;
  EXPECT_EQ(errorsOf({}, {faint}, options).all.false_alarms, 1);
  options.min_existence = 0.5;
  EXPECT_EQ(errorsOf({}, {faint}, options).all.false_alarms, 0);
}

TEST(ObjectError, RulesComeFromTheObjectDatabase) {
  const auto rules = classRules(
      ObjectDatabase::fromText("[table]\nshape = cuboid\nsymmetry = 2\n[person]\nlandmark = false\n"));
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_EQ(rules.at("table").symmetry, 2);
}

}  // namespace
}  // namespace roomgraph
