// SPDX-License-Identifier: BSD-3-Clause
// Ends of a sofa seen one at a time: the length that ties them together, against least squares by hand.
#include "landmark_views.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/geometry/covariance.h"
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
  out.shape.width += 0.2;  // as far as it is known
  return out;
}

enum class End { kLeft, kRight };

// A fit of the usual length that holds the end that it sees, and knows the place but for the length. Reversed: front and
// back are confused.
Proposal holding(End end, bool reversed = false) {
  Proposal out;
  out.class_name = "sofa";
  out.has_yaw = true;
  out.shape = sofa().nominal();
  const double left = end == End::kLeft ? 1 : -1, middle = left * (kLength_m - out.shape.width) / 2;
  out.place_by_size(1, 0) = (reversed ? left : -left) / 2;
  out.camera_from_object = poseFromYpr(kMiddle.x(), kMiddle.y(), 0, kYaw, 0, 0) *
                           poseFromYpr(0, middle, 0, reversed ? std::numbers::pi : 0, 0, 0);
  return out;
}

// In the level world.
LandmarkSighting inWorld(const Proposal& proposal) {
  LandmarkSighting out{.factor = {.landmark = landmark().id}, .proposal = &proposal, .size_weight = 1};
  out.factor.position_in_robot = proposal.camera_from_object.translation();
  out.factor.yaw_in_robot = planarPart(proposal.camera_from_object).yaw;
  out.factor.has_yaw = true;
  out.factor.weight = 1;
  out.factor.covariance = 0.01 * Eigen::Matrix4d::Identity();
  out.factor.covariance.topLeftCorner<2, 2>() =
      kEndSigma_m * kEndSigma_m * Eigen::Matrix2d::Identity() +
      placeSpread(proposal.place_by_size, out.factor.yaw_in_robot, proposal.size_information, sofa().sizeSigma());
  return out;
}

LandmarkSighting seenFrom(const KeyPose& node, const Proposal& proposal) {
  LandmarkSighting out = inWorld(proposal);
  out.factor.node = node.id;
  out.factor.position_in_robot = node.world_from_robot.inverse() * out.factor.position_in_robot;
  out.factor.yaw_in_robot -= planarPart(node.world_from_robot).yaw;
  out.factor.covariance = rotateCovariance(out.factor.covariance, node.world_from_robot.linear().transpose());
  return out;
}

// Key poses of a camera in a hand, tilted, from each of which one proposal is seen.
struct Recording {
  explicit Recording(const std::vector<Proposal>& seen, double seconds_between = 1) : proposals(seen) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      poses.add(seconds_between * static_cast<double>(i), poseFromYpr(0, 0.1 * static_cast<double>(i), 1.2, 0.4, 0.2, -0.15));
      const KeyPose& node = poses.nodes().back();
      sightings[node.id].push_back(seenFrom(node, proposals[i]));
    }
    options.landmark_sigma_share = 0.5;
    options.landmark_robust_width = 0;
    options.landmark_view_rad = 1;
  }
  ObjectFactors factors() const {
    ObjectFactors out;
    EXPECT_TRUE(addViews(sightings, landmark(), &sofa(), poses, options, out));
    return out;
  }

  const MotionSource none{MotionNoise{}, true};
  KeyPoses poses{{none, none, none}};
  std::vector<Proposal> proposals;
  SightingsByNode sightings;
  BackendOptions options;
};

LandmarkEstimate optimum(const ObjectFactors& factors, const KeyPoses& poses) {
  FactorGraph graph;
  for (const auto& node : poses.nodes()) graph.addPose(node.id, node.world_from_robot, true);
  graph.addLandmark(landmark().id, {landmark().position, kYaw, landmark().shape});
  for (const auto& [id, view] : factors.views) graph.addLandmark(id, view);
  for (const auto& factor : factors.shared_errors) graph.add(factor);
  for (const auto& factor : factors.sightings) graph.add(factor);
  for (const auto& factor : factors.sizes) graph.add(factor);
  EXPECT_TRUE(graph.optimize().usable);
  return graph.landmark(landmark().id);
}

const Eigen::Vector2d kLeftwards(-std::sin(kYaw), std::cos(kYaw));

TEST(LandmarkViews, TheEndThatWasSeenStaysWhateverTheLength) {
  for (const bool reversed : {false, true}) {
    const Proposal left = holding(End::kLeft, reversed);
    ObjectShape longer = left.shape;
    longer.width += 0.4;
    const LandmarkFactor placed = atSize(longer, inWorld(left), sofa());
    const Eigen::Vector2d end = kMiddle.head<2>() + kLength_m / 2 * kLeftwards;
    EXPECT_LT((placed.position_in_robot.head<2>() + longer.width / 2 * kLeftwards - end).norm(), 1e-9) << reversed;
    EXPECT_TRUE((placed.covariance.topLeftCorner<2, 2>())
                    .isApprox(kEndSigma_m * kEndSigma_m * Eigen::Matrix2d::Identity(), 1e-9))
        << "where the length is known, what is not known of it makes nothing uncertain";
  }
}

// However wrong the size's share may be, a place does not become certain.
TEST(LandmarkViews, APlaceStaysUncertain) {
  const Proposal left = holding(End::kLeft);
  LandmarkSighting sure = inWorld(left);
  sure.factor.covariance.topLeftCorner<2, 2>() *= 0.01;
  const Eigen::Matrix2d place = atSize(left.shape, sure, sofa()).covariance.topLeftCorner<2, 2>();
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(place).eigenvalues()(0), 1e-4 - 1e-12);
}

// Unknown are the middle and the length: each end gives one equation, the usual length another.
TEST(LandmarkViews, TwoEndsSeenFromOneDirectionTellTheLength) {
  for (const bool reversed : {false, true}) {
    const Recording recording({holding(End::kLeft), holding(End::kRight, reversed)});
    const ObjectFactors factors = recording.factors();
    EXPECT_EQ(factors.views.size(), 2u) << "one of each end";
    const auto& nodes = recording.poses.nodes();
    ASSERT_EQ(directionOf(landmark().position, nodes[0], 1), directionOf(landmark().position, nodes[1], 1));
    const LandmarkEstimate sofa_seen = optimum(factors, recording.poses);
    const double end = 1 / std::pow(recording.options.landmark_sigma_share * kEndSigma_m, 2),
                 usual = 1 / std::pow(sofa().width_sigma_m, 2);
    const double length = (end / 2 * kLength_m + usual * sofa().width_m) / (end / 2 + usual);
    EXPECT_NEAR(sofa_seen.shape.width, length, 1e-3) << reversed;
    EXPECT_GT(length, 2.29) << "hardly the usual one";
    EXPECT_LT((sofa_seen.position - kMiddle).head<2>().norm(), 1e-3) << reversed;
  }
}

// The same end from one direction again is one view, whose length stays the usual one.
TEST(LandmarkViews, OneEndTellsNoLength) {
  const Recording recording({holding(End::kLeft), holding(End::kLeft)});
  const ObjectFactors factors = recording.factors();
  EXPECT_EQ(factors.views.size(), 1u);
  const LandmarkEstimate seen = optimum(factors, recording.poses);
  EXPECT_NEAR(seen.shape.width, sofa().width_m, 1e-3);
  const Eigen::Vector2d end = seen.position.head<2>() + seen.shape.width / 2 * kLeftwards;
  EXPECT_LT((end - kMiddle.head<2>() - kLength_m / 2 * kLeftwards).norm(), 1e-3) << "the end is where it was seen";
}

// A key pose in between that sees the other end sees the sofa.
TEST(LandmarkViews, AVisitOfOneEndGoesOnWhileTheOtherIsSeen) {
  const Recording recording({holding(End::kLeft), holding(End::kRight), holding(End::kLeft)}, 4);
  EXPECT_EQ(recording.factors().sightings.size(), 2u) << "one of each end";
}

// Without an error that views share nothing ties a sighting to the size: it stays what it was.
TEST(LandmarkViews, SwitchedOffTheSizesShareStaysInTheCovariance) {
  const Proposal left = holding(End::kLeft);
  const Eigen::Matrix2d whole = 0.25 * inWorld(left).factor.covariance.topLeftCorner<2, 2>();
  for (const bool views : {false, true}) {
    Recording recording({left});
    recording.options.object_views = views;
    recording.options.object_sizes = !views;
    const LandmarkFactor sighting = recording.factors().sightings.front();
    const Pose3& pose = recording.poses.nodes().front().world_from_robot;
    const Eigen::Matrix2d covariance = rotateCovariance(sighting.covariance, pose.linear()).topLeftCorner<2, 2>();
    EXPECT_TRUE(covariance.isApprox(views ? Eigen::Matrix2d(0.5 * whole) : whole, 1e-9)) << views;
    const double moved = (pose * sighting.position_in_robot - left.camera_from_object.translation()).norm();
    EXPECT_NEAR(moved, views ? std::abs(landmark().shape.width - left.shape.width) / 2 : 0, 1e-9);
  }
}

}  // namespace
}  // namespace roomgraph::test
