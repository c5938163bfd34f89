// SPDX-License-Identifier: BSD-3-Clause
// Names of the JSON figures, and null for undefined ones.
#include "roomgraph/evaluation/report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "usual_classes.h"

namespace roomgraph {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(Report, StableNames) {
  TrajectoryErrors trajectory;
  trajectory.ate_m = summarize({0.1, 0.3});
  trajectory.rpe_trans_m = summarize({0.02});
  trajectory.rpe_rot_deg = summarize({1.5});
  trajectory.pairs = 2;
  trajectory.coverage = 0.75;
  const json t = json::parse(toJson(trajectory));
  EXPECT_DOUBLE_EQ(t.at("ate_mean_m"), 0.2);
  EXPECT_DOUBLE_EQ(t.at("ate_median_m"), 0.2);
  EXPECT_DOUBLE_EQ(t.at("ate_max_m"), 0.3);
  EXPECT_NEAR(t.at("ate_rmse_m").get<double>(), 0.2236068, 1e-6);
  EXPECT_DOUBLE_EQ(t.at("rpe_trans_rmse_m"), 0.02);
  EXPECT_DOUBLE_EQ(t.at("rpe_rot_rmse_deg"), 1.5);
  EXPECT_EQ(t.at("pairs"), 2);
  EXPECT_EQ(t.at("coverage"), 0.75);

  RelationErrors relations;
  relations.trans_m = summarize({0.2, 0.4});
  relations.rot_deg = summarize({1, 2});
  const json r = json::parse(toJson(relations));
  EXPECT_NEAR(r.at("trans_abs_mean_m").get<double>(), 0.3, 1e-12);
  EXPECT_NEAR(r.at("trans_abs_std_m").get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(r.at("trans_sqr_mean_m2").get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(r.at("rot_abs_mean_deg").get<double>(), 1.5, 1e-12);
  EXPECT_NEAR(r.at("rot_abs_std_deg").get<double>(), 0.5, 1e-12);
}

TEST(Report, EveryLandmarkSaysHowFarItIsInItsOwnStandardDeviations) {
  EvaluatedObject chair;
  chair.class_name = "swivel_chair";
  chair.width = chair.depth = chair.height = 0.6;
  EvaluatedObject seen = chair;
  seen.position.x() = 0.06;
  seen.place_covariance = Eigen::Matrix2d(Eigen::Vector2d(0.03 * 0.03, 1).asDiagonal());
  ObjectOptions options;
  options.classes = test::usualClasses();
  const auto nees = [&] {
    return json::parse(toJson(evaluateObjects({chair}, {seen}, options))).at("landmarks").at(0).at("position_nees");
  };
  EXPECT_NEAR(nees().get<double>(), 4, 1e-9);
  seen.place_covariance.reset();
  EXPECT_TRUE(nees().is_null());
}

TEST(Report, WhatCannotBeComputedIsNull) {
  const json t = json::parse(toJson(TrajectoryErrors{}));
  EXPECT_TRUE(t.at("ate_rmse_m").is_null());
  EXPECT_EQ(t.at("pairs"), 0);
  const json o = json::parse(toJson(evaluateObjects({}, {})));
  EXPECT_TRUE(o.at("precision").is_null());
  EXPECT_TRUE(o.at("recall").is_null());
  EXPECT_TRUE(o.at("iou3d_mean").is_null());
  EXPECT_EQ(o.at("correct"), 0);
  const json d = json::parse(toJson(DetectionErrors{}));
  for (const auto* name : {"precision", "recall", "f1", "ap"}) EXPECT_TRUE(d.at(name).is_null()) << name;
  EXPECT_TRUE(d.at("mean").at("ap").is_null());
  const json m = json::parse(toJson(MapErrors{}));
  for (const auto* name : {"precision", "recall", "f1", "agreement", "wall_distance_mean_m",
                           "wall_distance_median_m", "wall_distance_p95_m", "wall_distance_reverse_p95_m"})
    EXPECT_TRUE(m.at(name).is_null()) << name;
  const json a = json::parse(toJson(evaluateObjects({}, {}), AssociationErrors{}));
  EXPECT_TRUE(a.at("association_accuracy").is_null());
  EXPECT_TRUE(a.at("association_ece").is_null());
  EXPECT_TRUE(a.at("association_reliability").at(9).at("correct_share").is_null());
  EXPECT_EQ(a.at("association_reliability").at(9).at("to"), 1.0);
  EXPECT_TRUE(a.at("recall").is_null()) << "the landmarks' figures are in the same object";
  AssociationErrors some;
  some.reliability[9] = {1114, 0.999, 0.997};
  EXPECT_THAT(toTable(some), HasSubstr("\nprobability     count   mean p  correct\n0.9 .. 1.0       1114    0.999    0.997\n"));
  EXPECT_THAT(toTable(AssociationErrors{}) + toTable(MapErrors{}) + toTable(DetectionErrors{}),
              HasSubstr(" - "));
}

TEST(Report, ObjectFiguresAndVerdicts) {
  EvaluatedObject sofa;
  sofa.id = 7;
  sofa.class_name = sofa.kind = "sofa";
  sofa.width = sofa.depth = sofa.height = 1;
  auto elsewhere = sofa;
  elsewhere.id = 8;
  elsewhere.position.x() = 9;
  ObjectOptions options;
  options.classes = test::usualClasses();
  const auto errors = evaluateObjects({sofa}, {sofa, elsewhere}, options);
  const json o = json::parse(toJson(errors));
  EXPECT_EQ(o.at("precision"), 0.5);
  EXPECT_EQ(o.at("recall"), 1.0);
  EXPECT_EQ(o.at("position_error_mean_m"), 0.0);
  EXPECT_EQ(o.at("yaw_error_mean_deg"), 0.0);
  EXPECT_EQ(o.at("per_class").at("sofa").at("false_alarms"), 1);
  EXPECT_TRUE(o.at("per_class").at("door").at("recall").is_null());
  EXPECT_EQ(o.at("landmarks").at(1).at("verdict"), "false alarm");
  EXPECT_TRUE(o.at("landmarks").at(1).at("truth").is_null());
  const std::string table = toTable(errors);
  EXPECT_THAT(table, HasSubstr("landmark 8 (sofa): false alarm\n"));
  EXPECT_THAT(table, HasSubstr("0.500"));
}

}  // namespace
}  // namespace roomgraph
