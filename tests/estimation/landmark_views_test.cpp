// SPDX-License-Identifier: BSD-3-Clause
// Ends of a sofa seen one at a time: the length that ties them together, against least squares by hand.
#include "landmark_views.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "roomgraph/backend/factor_graph.h"
#include "shipped_objects.h"

namespace roomgraph::test {
namespace {

constexpr double kLength_m = 2.3, kEndSigma_m = 0.06, kYaw = 0.5;
const Eigen::Vector3d kMiddle(4, 1, 0);

const ObjectModel& sofa() {
  return *shippedObjects().find("sofa");
}

Landmark landmark() {
  Landmark out;
  out.id = LandmarkId{2};
  out.class_name = out.model = "sofa";
  out.position = kMiddle + Eigen::Vector3d(0.1, -0.1, 0);
  out.yaw = kYaw;
  out.has_yaw = true;
  out.shape = sofa().nominal();
  return out;
}

enum class End { kLeft, kRight };

// A fit of the usual length that holds the end that it sees, and knows the place but for the length.
Proposal holding(End end) {
  Proposal out;
  out.class_name = "sofa";
  out.has_yaw = true;
  out.shape = sofa().nominal();
  out.place_by_size(1, 0) = end == End::kLeft ? -0.5 : 0.5;
  const double middle = (end == End::kLeft ? 1 : -1) * (kLength_m - out.shape.width) / 2;
  out.camera_from_object = poseFromYpr(kMiddle.x(), kMiddle.y(), 0, kYaw, 0, 0) * poseFromYpr(0, middle, 0, 0, 0, 0);
  return out;
}

// From a robot at the world's origin.
LandmarkSighting sightingOf(const Proposal& proposal, std::int64_t node) {
  LandmarkSighting out{.factor = {.node = NodeId{node}, .landmark = landmark().id}, .proposal = &proposal, .size_weight = 1};
  out.factor.position_in_robot = proposal.camera_from_object.translation();
  out.factor.yaw_in_robot = planarPart(proposal.camera_from_object).yaw;
  out.factor.has_yaw = true;
  out.factor.weight = 1;
  out.factor.covariance = 0.01 * Eigen::Matrix4d::Identity();
  const PlaceBySize lever = Eigen::Rotation2Dd(kYaw).toRotationMatrix() * proposal.place_by_size;
  out.factor.covariance.topLeftCorner<2, 2>() = kEndSigma_m * kEndSigma_m * Eigen::Matrix2d::Identity() +
                                                placeSpread(lever, proposal.size_information, sofa().sizeSigma());
  return out;
}

TEST(LandmarkViews, TheEndThatWasSeenStaysWhateverTheLength) {
  const Proposal left = holding(End::kLeft);
  ObjectShape longer = left.shape;
  longer.width += 0.4;
  const LandmarkFactor placed = atSize(longer, sightingOf(left, 0), sofa());
  const Eigen::Vector2d across(-std::sin(kYaw), std::cos(kYaw));
  const Eigen::Vector2d end = kMiddle.head<2>() + kLength_m / 2 * across;
  EXPECT_LT((placed.position_in_robot.head<2>() + longer.width / 2 * across - end).norm(), 1e-9);
  EXPECT_TRUE((placed.covariance.topLeftCorner<2, 2>())
                  .isApprox(kEndSigma_m * kEndSigma_m * Eigen::Matrix2d::Identity(), 1e-9))
      << "where the length is known, what is not known of it makes nothing uncertain";
}

// However wrong the size's share may be, a place does not become certain.
TEST(LandmarkViews, APlaceStaysUncertain) {
  const Proposal left = holding(End::kLeft);
  LandmarkSighting sure = sightingOf(left, 0);
  sure.factor.covariance.topLeftCorner<2, 2>() *= 0.01;
  const Eigen::Matrix2d place = atSize(left.shape, sure, sofa()).covariance.topLeftCorner<2, 2>();
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(place).eigenvalues()(0), 1e-4 - 1e-12);
}

// Unknown are the middle and the length: each end gives one equation, the usual length another.
TEST(LandmarkViews, TwoEndsSeenFromOneDirectionTellTheLength) {
  const MotionSource none(MotionNoise{}, true);
  KeyPoses poses({none, none, none});
  const Proposal left = holding(End::kLeft), right = holding(End::kRight);
  SightingsByNode sightings;
  for (int i = 0; i < 2; ++i) {
    poses.add(i, Pose3::Identity());
    sightings[NodeId{i}].push_back(sightingOf(i ? right : left, i));
  }
  BackendOptions options;
  options.landmark_sigma_share = 0.5;
  options.landmark_robust_width = 0;
  ObjectFactors factors;
  ASSERT_TRUE(addViews(sightings, landmark(), &sofa(), poses, options, factors));
  EXPECT_EQ(factors.views.size(), 2u) << "one of each end, though the direction is the same";

  FactorGraph graph;
  for (const auto& node : poses.nodes()) graph.addPose(node.id, node.world_from_robot, true);
  graph.addLandmark(landmark().id, {landmark().position, kYaw, landmark().shape});
  for (const auto& [id, view] : factors.views) graph.addLandmark(id, view);
  for (const auto& factor : factors.shared_errors) graph.add(factor);
  for (const auto& factor : factors.sightings) graph.add(factor);
  for (const auto& factor : factors.sizes) graph.add(factor);
  ASSERT_TRUE(graph.optimize().usable);

  const double end = 1 / std::pow(options.landmark_sigma_share * kEndSigma_m, 2),
               usual = 1 / std::pow(sofa().width_sigma_m, 2);
  const double length = (end / 2 * kLength_m + usual * sofa().width_m) / (end / 2 + usual);
  EXPECT_NEAR(graph.landmark(landmark().id).shape.width, length, 1e-3);
  EXPECT_GT(length, 2.29) << "hardly the usual one";
  EXPECT_LT((graph.landmark(landmark().id).position - kMiddle).head<2>().norm(), 1e-3);
}

}  // namespace
}  // namespace roomgraph::test
