// SPDX-License-Identifier: BSD-3-Clause
// Poses that move with another one: as if stiff movements held them, for every kind of factor.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "errors_of.h"
#include "object_views.h"
#include "residual_specimens.h"
#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph::test {
namespace {

const LandmarkId kSofa{3};
const ObjectShape kShape{ShapeKind::kCuboid, 1.8, 0.9, 0.8};
const Pose3 kSofaPose = poseFromYpr(0.4, -0.2, 0, 0.5, 0, 0);
const PointId kPoint{7};
const Eigen::Vector3d kPlace(0.3, 0.2, 0.5);
const NodeId kHeld{9};
// The first and the third lead, and are tilted like cameras in a hand; the second and the fourth look at the sofa, on a floor
// that is not quite level.
const std::array<Pose3, 4> kPoses{poseFromYpr(3.2, -1.6, 0.01, 2.2, 0.9, 0.004), poseFromYpr(3.4, 0.2, 0, 3.1, -0.006, 0.01),
                                  poseFromYpr(1.9, 3.4, 0, -1.5, 0, 0.3), poseFromYpr(0.2, 3.5, 0.01, -1.55, 0.02, 0)};
constexpr std::array<int, 4> kLeader{0, 0, 2, 2};

Pose3 robotFromCamera() {
  Pose3 out = Pose3::Identity();
  out.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  out.translation() = Eigen::Vector3d(0.1, -0.05, 1.1);
  return out;
}

const Pose3& at(NodeId node) { return kPoses[static_cast<std::size_t>(node.value)]; }

class Measured {
 public:
  explicit Measured(unsigned seed) : random_(seed) {}

  BetweenFactor movement(NodeId a, NodeId b) {
    BetweenFactor f{a, b, at(a).inverse() * at(b) * random_.pose(noise_, noise_)};
    f.covariance = 0.01 * randomCovariance<6>(random_);
    return f;
  }
  BetweenFactor fromHeld(NodeId b) {
    BetweenFactor f{kHeld, b, at(b) * random_.pose(noise_, noise_)};
    f.covariance = 0.01 * randomCovariance<6>(random_);
    return f;
  }
  GroundFactor floor(NodeId node) {
    return {.node = node,
            .normal_in_robot = at(node).linear().transpose() * (Eigen::Vector3d::UnitZ() + random_.vector(noise_)),
            .offset_m = at(node).translation().z() + random_.uniform(-noise_, noise_)};
  }
  LandmarkFactor sighting(NodeId node) {
    LandmarkFactor f{.node = node, .landmark = kSofa, .has_yaw = true, .weight = 0.7};
    f.position_in_robot = at(node).inverse() * kSofaPose.translation() + random_.vector(noise_);
    f.yaw_in_robot = 0.5 - planarPart(at(node)).yaw + random_.uniform(-noise_, noise_);
    f.covariance = 0.01 * randomCovariance<4>(random_);
    return f;
  }
  LandmarkBoxFactor box(NodeId node) {
    LandmarkBoxFactor f{.node = node, .landmark = kSofa, .camera = testCamera(), .robot_from_camera = robotFromCamera()};
    f.box = projectShape(kShape, (at(node) * robotFromCamera()).inverse() * kSofaPose, f.camera).value().full;
    f.box.u_min += random_.uniform(-1, 1);
    return f;
  }
  LandmarkSideFactor side(NodeId node) {
    return {.node = node,
            .landmark = kSofa,
            .point_in_robot = at(node).inverse() * (kSofaPose * Eigen::Vector3d(0.45, 0.3, 0.3)) + random_.vector(noise_)};
  }
  CameraPointFactor view(NodeId node) {
    CameraPointFactor f{.node = node, .point = kPoint, .camera = testCamera(), .robot_from_camera = robotFromCamera()};
    const Eigen::Vector3d p = (at(node) * robotFromCamera()).inverse() * kPlace;
    f.pixel = {f.camera.fx * p.x() / p.z() + f.camera.cx + random_.uniform(-1, 1), f.camera.fy * p.y() / p.z() + f.camera.cy};
    f.depth_m = p.z() + random_.uniform(-noise_, noise_);
    return f;
  }

 private:
  Random random_;
  double noise_ = 0.003;
};

std::vector<Factor> everyKind(unsigned seed) {
  Measured m(seed);
  const NodeId a{1}, b{3};
  return {m.movement(a, b), m.movement(NodeId{0}, b), m.movement(b, NodeId{0}), m.fromHeld(a), m.floor(a), m.floor(b),
          m.sighting(a), m.sighting(b), m.box(a), m.box(b), m.side(a), m.side(b), m.view(a), m.view(b),
          PlanarFactor{a}, PlanarFactor{b}, LandmarkGroundFactor{kSofa}, LandmarkSizeFactor{kSofa, {1.7, 1, 0.8}, {0.2, 0.2, 0.2}},
          PointLandmarkFactor{kPoint, kSofa}};
}

// `stiff`: the followers are held by movements of a tenth of a millimetre.
FactorGraph graphOf(const std::vector<Factor>& factors, bool stiff) {
  FactorGraph graph;
  graph.addPose(kHeld, Pose3::Identity(), true);
  for (int i = 0; i < 4; ++i) {
    const NodeId leader{kLeader[static_cast<std::size_t>(i)]}, id{i};
    if (stiff || leader == id)
      graph.addPose(id, at(id));
    else
      graph.attach(id, leader, at(id));
    if (stiff && leader != id) graph.add(BetweenFactor{leader, id, at(leader).inverse() * at(id), 1e-8 * Matrix6d::Identity()});
  }
  graph.addLandmark(kSofa, {kSofaPose.translation(), 0.5, kShape});
  graph.addPoint(kPoint, kPlace);
  for (const Factor& factor : factors) graph.add(factor);
  return graph;
}

TEST(AttachedPoses, AreWhereStiffMovementsHoldThem) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    FactorGraph stiff = graphOf(everyKind(seed), true), attached = graphOf(everyKind(seed), false);
    ASSERT_TRUE(stiff.optimize({.max_iterations = 200, .function_tolerance = 1e-14}).usable);
    ASSERT_TRUE(attached.optimize({.max_iterations = 200, .function_tolerance = 1e-14}).usable);
    double moved = 0;
    for (int i = 0; i < 4; ++i) {
      const Pose3 difference = stiff.pose(NodeId{i}).inverse() * attached.pose(NodeId{i});
      EXPECT_LT(difference.translation().norm(), 1e-4) << "pose " << i << ", seed " << seed;
      EXPECT_LT(rotationAngle(difference), 1e-4) << "pose " << i << ", seed " << seed;
      moved = std::max(moved, (attached.pose(NodeId{i}).translation() - at(NodeId{i}).translation()).norm());
    }
    EXPECT_GT(moved, 1e-3) << "measurements without errors prove nothing";
    EXPECT_LT((stiff.landmark(kSofa).position - attached.landmark(kSofa).position).norm(), 1e-4);
    EXPECT_NEAR(stiff.landmark(kSofa).yaw, attached.landmark(kSofa).yaw, 1e-4);
    EXPECT_LT((stiff.point(kPoint) - attached.point(kPoint)).norm(), 1e-4);
    EXPECT_NEAR(stiff.chiSquared(), attached.chiSquared(), 0.01 * stiff.chiSquared());
  }
}

// Each kind alone, where the leaders have moved.
TEST(AttachedPoses, CostWhatTheyCostByThemselves) {
  for (const Factor& factor : everyKind(1)) {
    FactorGraph attached = graphOf({factor}, false), free;
    free.addPose(kHeld, Pose3::Identity(), true);
    Random random(5);
    const Pose3 moves[] = {random.pose(0.004, 0.004), random.pose(0.004, 0.004)};
    for (int i = 0; i < 4; ++i) {
      const auto leader = static_cast<std::size_t>(kLeader[static_cast<std::size_t>(i)]);
      const Pose3 there = kPoses[leader] * moves[leader / 2] * kPoses[leader].inverse() * at(NodeId{i});
      free.addPose(NodeId{i}, there);
    }
    free.addLandmark(kSofa, {kSofaPose.translation(), 0.5, kShape});
    free.addPoint(kPoint, kPlace);
    free.add(factor);
    std::vector<double> values = attached.values();
    // Poses come first, by ids: 0, 2 and the held one.
    for (std::size_t k = 0; k < 2; ++k) {
      const Pose3 leader = kPoses[2 * k] * moves[k];
      const Eigen::Quaterniond q(leader.linear());
      for (std::size_t i = 0; i < 3; ++i) values[7 * k + i] = leader.translation()[static_cast<Eigen::Index>(i)];
      for (std::size_t i = 0; i < 4; ++i) values[7 * k + 3 + i] = q.coeffs()[static_cast<Eigen::Index>(i)];
    }
    attached.setValues(values);
    EXPECT_NEAR(attached.chiSquared(), free.chiSquared(), 0.02 * free.chiSquared() + 1e-9) << "kind " << factor.index();
  }
}

TEST(AttachedPoses, MovementWithinABodySaysNothing) {
  Measured m(2);
  FactorGraph graph = graphOf({}, false);
  const std::size_t before = graph.factors();
  graph.add(m.movement(NodeId{0}, NodeId{1}));
  graph.add(m.movement(NodeId{3}, NodeId{2}));
  EXPECT_EQ(graph.factors(), before);
  graph.add(m.movement(NodeId{1}, NodeId{3}));
  EXPECT_EQ(graph.factors(), before + 1);
  EXPECT_EQ(graph.bodyOf(NodeId{1}), NodeId{0});
  EXPECT_EQ(graph.bodyOf(NodeId{0}), NodeId{0});
}

TEST(AttachedPoses, WhatHoldsForOnePoseIsRefused) {
  FactorGraph graph = graphOf({}, false);
  const MarginalPrior prior{.variables = {.nodes = {NodeId{3}}}};
  EXPECT_NE(messageOf<std::invalid_argument>([&] { graph.add(prior); }).find("pose 3 "), std::string::npos);
  EXPECT_THROW(graph.attach(NodeId{1}, NodeId{0}, Pose3::Identity()), std::invalid_argument) << "twice";
  EXPECT_THROW(graph.attach(NodeId{0}, NodeId{2}, Pose3::Identity()), std::invalid_argument) << "there already";
  EXPECT_THROW(graph.attach(NodeId{4}, NodeId{1}, Pose3::Identity()), std::invalid_argument) << "to one that is attached";
  EXPECT_THROW(graph.attach(NodeId{4}, NodeId{5}, Pose3::Identity()), std::out_of_range) << "to none";
}

}  // namespace
}  // namespace roomgraph::test
