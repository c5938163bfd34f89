// SPDX-License-Identifier: BSD-3-Clause
// Proposal and ground errors, and normalised errors of consistent samples.
#include "roomgraph/evaluation/proposal_error.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "roomgraph/evaluation/report_proposals.h"

namespace roomgraph {
namespace {

Proposal at(double x, double y, double yaw) {
  Proposal p;
  p.shape = {ShapeKind::kCuboid, 2, 1, 1};
  p.camera_from_object = toPose3(Pose2{x, y, yaw});
  p.covariance = Eigen::Vector4d(0.04, 0.01, 1, 1).asDiagonal();
  return p;
}

ProposalCase caseAt(double x) {
  ProposalCase c;
  c.class_name = "sofa";
  c.rule = {ShapeKind::kCuboid, 1};
  c.truth = {ShapeKind::kCuboid, 2, 1, 1};
  c.camera_from_truth = toPose3(Pose2{x, 0, 0});
  return c;
}

TEST(ProposalError, TopAndBest) {
  ProposalCase c = caseAt(3);
  c.proposals = {at(3.2, 0, 0.5), at(3, 0.1, 0)};
  ProposalCase none = caseAt(4);
  const auto figures = evaluateProposals({c, none}).at("sofa");
  EXPECT_EQ(figures.detections, 2);
  EXPECT_EQ(figures.without_proposal, 1);
  EXPECT_NEAR(figures.center_top_m.median, 0.2, 1e-9);
  EXPECT_NEAR(figures.center_best_m.median, 0.1, 1e-9);
  EXPECT_NEAR(figures.yaw_top_deg.median, 28.648, 1e-3);
  EXPECT_NEAR(figures.yaw_best_deg.median, 0, 1e-9);
  EXPECT_NEAR(figures.iou3d_best_median, 1.9 / 2.1, 1e-9);
  EXPECT_NEAR(figures.share_good, 0.5, 1e-9);
  EXPECT_NEAR(figures.away_mean_m, 0.2, 1e-9);
  EXPECT_NEAR(figures.left_mean_m, 0, 1e-9);
  EXPECT_NEAR(figures.nees_mean, 0.2 * 0.2 / 0.04, 1e-9);
}

TEST(ProposalError, TheBestMayStandAnywhereInTheList) {
  ProposalCase c = caseAt(3);
  c.proposals = {at(3.2, 0, 0.5), at(3, 0.1, 0), at(3.6, 0, 1)};
  const auto figures = evaluateProposals({c}).at("sofa");
  EXPECT_NEAR(figures.center_best_m.median, 0.1, 1e-9);
  EXPECT_NEAR(figures.yaw_best_deg.median, 0, 1e-9);
  EXPECT_NEAR(figures.iou3d_best_median, 1.9 / 2.1, 1e-9);
}

TEST(ProposalError, YawIsTakenModuloSymmetry) {
  ProposalCase c = caseAt(3);
  c.rule.symmetry = 2;
  c.proposals = {at(3, 0, std::numbers::pi)};
  EXPECT_NEAR(evaluateProposals({c}).at("sofa").yaw_top_deg.median, 0, 1e-6);
}

// Errors drawn from the covariance have a mean normalised error of 2.
TEST(ProposalError, NormalisedErrorOfConsistentProposals) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<ProposalCase> cases;
  for (int i = 0; i < 3000; ++i) {
    cases.push_back(caseAt(3));
    cases.back().proposals = {at(3 + 0.2 * normal(random), 0.1 * normal(random), 0)};
  }
  EXPECT_NEAR(evaluateProposals(cases).at("sofa").nees_mean, 2, 0.15);
}

TEST(GroundError, AnglesHeightsAndNormalisedError) {
  const Plane truth{Eigen::Vector3d(0, -1, 0), 0.8};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<GroundCase> cases(1, {truth, std::nullopt});
  for (int i = 0; i < 2000; ++i) {
    GroundEstimate estimate;
    estimate.from_depth = true;
    estimate.plane.normal =
        (expSO3({0.002 * normal(random), 0, 0.002 * normal(random)}) * truth.normal).eval();
    estimate.plane.offset = truth.offset + 0.01 * normal(random);
    estimate.covariance = Eigen::Vector4d(4e-6, 0, 4e-6, 1e-4).asDiagonal();
    cases.push_back({truth, estimate});
  }
  const GroundFigures figures = evaluateGround(cases);
  EXPECT_EQ(figures.frames, 2001);
  EXPECT_EQ(figures.found, 2000);
  EXPECT_NEAR(figures.nees_mean, 3, 0.2);
  EXPECT_NEAR(figures.share_good, 0.954, 0.02);
  EXPECT_EQ(figures.wrong, 0);
}

TEST(ProposalReport, TableAndJson) {
  ProposalCase c = caseAt(3);
  c.proposals = {at(3.2, 0, 0)};
  ProposalBenchmark b{evaluateProposals({c}), evaluateGround({}), {{1, summarize({2.5})}}};
  EXPECT_NE(toTable(b).find("sofa"), std::string::npos);
  const auto json = nlohmann::json::parse(toJson(b));
  EXPECT_NEAR(json.at("per_class").at("sofa").at("center_top_median_m").get<double>(), 0.2, 1e-9);
  EXPECT_TRUE(json.at("ground").at("angle_median_deg").is_null());
  EXPECT_EQ(json.at("cpu_ms").at(0).at("boxes"), 1);
}

}  // namespace
}  // namespace roomgraph
