// SPDX-License-Identifier: BSD-3-Clause
// Box, point and size factors: exact measurements give back pose, size and points.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "errors_of.h"
#include "object_views.h"
#include "roomgraph/backend/factor_graph.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph::test {
namespace {

const ObjectShape kSofa{ShapeKind::kCuboid, 1.8, 0.9, 0.8};
const Pose3 kSofaPose = poseFromYpr(0.4, -0.2, 0, 0.5, 0, 0);
const LandmarkId kId{3};

// Cameras at known poses on an arc around the object, 1.2 m up.
Pose3 viewer(int i) {
  const double angle = -0.8 + 0.4 * i;
  return lookingAt({3.5 * std::cos(angle), 3.5 * std::sin(angle), 1.2}, {0.3, 0, 0.4}, 0);
}

LandmarkBoxFactor boxFrom(int i) {
  LandmarkBoxFactor f{NodeId{i}, kId, testCamera()};
  f.box = projectShape(kSofa, viewer(i).inverse() * kSofaPose, f.camera).value().full;
  f.robust_width = 0;
  return f;
}

FactorGraph boxesAround(const LandmarkEstimate& start) {
  FactorGraph graph;
  graph.addLandmark(kId, start);
  for (int i = 0; i < 5; ++i) {
    graph.addPose(NodeId{i}, viewer(i), true);
    graph.add(boxFrom(i));
  }
  return graph;
}

LandmarkEstimate roughStart() {
  return {{0.2, 0.1, 0.1}, 0.3, {ShapeKind::kCuboid, 1.6, 1.0, 0.9}};
}

TEST(LandmarkBox, ExactBoxesGiveBackPlaceYawAndSize) {
  FactorGraph graph = boxesAround(roughStart());
  graph.add(LandmarkSizeFactor{kId, {1.6, 1.0, 0.9}, {10, 10, 10}});  // frees the size, hardly says anything
  ASSERT_TRUE(graph.optimize(200).usable);
  const LandmarkEstimate found = graph.landmark(kId);
  EXPECT_LT((found.position - kSofaPose.translation()).norm(), 1e-2) << found.position.transpose();
  EXPECT_NEAR(found.yaw, 0.5, 1e-2);
  EXPECT_NEAR(found.shape.width, kSofa.width, 2e-2);
  EXPECT_NEAR(found.shape.depth, kSofa.depth, 2e-2);
  EXPECT_NEAR(found.shape.height, kSofa.height, 1e-2);
}

TEST(LandmarkBox, SizeStaysUnlessAFactorSpeaksOfIt) {
  FactorGraph graph = boxesAround(roughStart());
  ASSERT_TRUE(graph.optimize().usable);
  const ObjectShape shape = graph.landmark(kId).shape;
  EXPECT_EQ(shape.width, 1.6);
  EXPECT_EQ(shape.depth, 1.0);
  EXPECT_EQ(shape.height, 0.9);
}

// A usual width of 1.8 +- .3 m and a least one, +- .1 m: their weighted mean, or the usual one where that is larger anyway.
TEST(LandmarkSize, ALeastSizePullsOnlyUpwards) {
  for (const double least : {1.5, 2.2}) {
    FactorGraph graph;
    graph.addLandmark(kId, {kSofaPose.translation(), 0.5, kSofa});
    graph.addPose(NodeId{0}, viewer(0), true);
    LandmarkFactor seen{.node = NodeId{0}, .landmark = kId};
    seen.position_in_robot = viewer(0).inverse() * kSofaPose.translation();
    graph.add(seen);
    graph.add(LandmarkSizeFactor{kId, {1.8, 0.9, 0.8}, {0.3, 0.1, 0.1}});
    graph.add(LandmarkSizeFactor{kId, {least, 0, 0}, {0.1, 0.1, 0.1}, true});
    ASSERT_TRUE(graph.optimize().usable);
    const double prior = 1 / (0.3 * 0.3), bound = 1 / (0.1 * 0.1);
    const double width = least < 1.8 ? 1.8 : (prior * 1.8 + bound * least) / (prior + bound);
    EXPECT_NEAR(graph.landmark(kId).shape.width, width, 1e-4) << least;
    EXPECT_NEAR(graph.landmark(kId).shape.depth, 0.9, 1e-4);
  }
}

TEST(LandmarkBox, CorrectsAPoseThatSeesAKnownLandmark) {
  FactorGraph moved;
  moved.addLandmark(kId, {kSofaPose.translation(), 0.5, kSofa});
  for (int i = 0; i < 5; ++i) {
    Pose3 pose = viewer(i);
    if (i == 2) pose.translation() += Eigen::Vector3d(0.1, -0.1, 0.05);
    moved.addPose(NodeId{i}, pose, i != 2);
    moved.add(boxFrom(i));
  }
  // The tilt is known; the place is not.
  BetweenFactor turn{NodeId{1}, NodeId{2}, viewer(1).inverse() * viewer(2), Matrix6d::Identity() * 100};
  turn.covariance.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-8;
  moved.add(turn);
  ASSERT_TRUE(moved.optimize(200).usable);
  EXPECT_LT((moved.pose(NodeId{2}).translation() - viewer(2).translation()).norm(), 5e-3);
}

TEST(LandmarkBox, LandmarkWithoutSizeIsAnError) {
  FactorGraph graph;
  graph.addPose(NodeId{0}, viewer(0), true);
  graph.addLandmark(kId, {});
  const auto message = messageOf<std::invalid_argument>([&] { graph.add(boxFrom(0)); });
  EXPECT_NE(message.find("landmark 3 has no size"), std::string::npos) << message;
  EXPECT_EQ(graph.factors(), 0u);
}

CameraPointFactor pointFrom(int i, const Eigen::Vector3d& point, PointId id, bool depth) {
  CameraPointFactor f{NodeId{i}, id, testCamera()};
  const Eigen::Vector3d seen = viewer(i).inverse() * point;
  f.pixel = f.camera.project(seen);
  if (depth) f.depth_m = seen.z();
  return f;
}

FactorGraph manyPoints(unsigned seed) {
  FactorGraph graph;
  Random random(seed);
  for (int i = 0; i < 4; ++i) graph.addPose(NodeId{i}, viewer(i) * random.pose(0.02, 0.02), i == 0);
  for (int k = 0; k < 30; ++k) {
    const Eigen::Vector3d point = random.vector(1);
    graph.addPoint(PointId{k}, point + random.vector(0.1));
    for (int i = 0; i < 4; ++i) graph.add(pointFrom(i, point, PointId{k}, (i + k) % 3 == 0));
  }
  return graph;
}

TEST(CameraPoint, ExactPixelsGiveBackPosesAndPoints) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    FactorGraph graph = manyPoints(seed);
    const Pose3 origin = graph.pose(NodeId{0});  // held a little off: everything moves with it
    ASSERT_TRUE(graph.optimize(100).usable);
    for (int i = 1; i < 4; ++i) {
      const Pose3 relative = origin.inverse() * graph.pose(NodeId{i});
      EXPECT_TRUE(relative.isApprox(viewer(0).inverse() * viewer(i), 1e-4))
          << "seed " << seed << " pose " << i;
    }
  }
}

TEST(CameraPoint, HuberBoundsTheInfluenceOfAWrongMatch) {
  const Eigen::Vector3d point(0.2, 0.3, 0.5);
  const auto errorWith = [&](double width) {
    FactorGraph graph;
    graph.addPoint(PointId{0}, point);
    for (int i = 0; i < 5; ++i) {
      graph.addPose(NodeId{i}, viewer(i), true);
      CameraPointFactor f = pointFrom(i, point, PointId{0}, true);
      if (i == 4) f.pixel.x() += 100;
      f.robust_width = width;
      graph.add(f);
    }
    EXPECT_TRUE(graph.optimize(100).usable);
    return (graph.point(PointId{0}) - point).norm();
  };
  EXPECT_GT(errorWith(0), 0.05) << "the wrong match is harmless: the test proves nothing";
  EXPECT_LT(errorWith(2.5), 0.2 * errorWith(0));
}

// A pixel ten standard deviations off: 2 w 10 - w^2 with Huber's loss, w^2 log(1 + (10 / w)^2) with Cauchy's.
TEST(CameraPoint, LossIsTheOneThatWasAskedFor) {
  const Eigen::Vector3d point(0.2, 0.3, 0.5);
  const auto chiSquared = [&](RobustLoss loss, double width) {
    FactorGraph graph;
    graph.addPoint(PointId{0}, point);
    graph.addPose(NodeId{0}, viewer(0), true);
    CameraPointFactor f = pointFrom(0, point, PointId{0}, false);
    f.pixel.x() += 10 * f.sigma_px;
    f.loss = loss;
    f.robust_width = width;
    graph.add(f);
    return graph.chiSquared();
  };
  EXPECT_NEAR(chiSquared(RobustLoss::kHuber, 2.5), 2 * 2.5 * 10 - 2.5 * 2.5, 1e-6);
  EXPECT_NEAR(chiSquared(RobustLoss::kCauchy, 2.5), 2.5 * 2.5 * std::log(1 + 16), 1e-6);
  EXPECT_NEAR(chiSquared(RobustLoss::kHuber, 0), 100, 1e-6);
}

TEST(PointLandmark, PullsALandmarkOverItsPoints) {
  FactorGraph graph;
  graph.addLandmark(kId, {{0.8, 0.3, 0.3}, 0.5, kSofa});
  for (int i = 0; i < 3; ++i) graph.addPose(NodeId{i}, viewer(i), true);
  for (int k = 0; k < 8; ++k) {  // just inside the corners
    const Eigen::Vector3d corner(k & 1 ? 0.44 : -0.44, k & 2 ? 0.89 : -0.89, k & 4 ? 0.79 : 0.01);
    graph.addPoint(PointId{k}, kSofaPose * corner);
    for (int i = 0; i < 3; ++i) graph.add(pointFrom(i, kSofaPose * corner, PointId{k}, true));
    graph.add(PointLandmarkFactor{PointId{k}, kId});
  }
  ASSERT_TRUE(graph.optimize(200).usable);
  EXPECT_LT((graph.landmark(kId).position - kSofaPose.translation()).norm(), 0.03)
      << graph.landmark(kId).position.transpose();
  EXPECT_EQ(graph.landmark(kId).yaw, 0.5) << "points inside a model do not measure its yaw";
}

TEST(ObjectFactors, SameBitsAgainAndInSeveralThreadsAtOnce) {
  FactorGraph alone = manyPoints(1);
  alone.optimize();
  std::vector<FactorGraph> graphs;
  for (int i = 0; i < 3; ++i) graphs.push_back(manyPoints(1));
  std::vector<std::thread> threads;
  for (auto& graph : graphs) threads.emplace_back([&graph] { graph.optimize(); });
  for (auto& thread : threads) thread.join();
  for (const auto& graph : graphs) {
    for (int i = 0; i < 4; ++i)
      EXPECT_TRUE(graph.pose(NodeId{i}).matrix() == alone.pose(NodeId{i}).matrix()) << i;
    for (int k = 0; k < 30; ++k) EXPECT_TRUE(graph.point(PointId{k}) == alone.point(PointId{k})) << k;
  }
}

}  // namespace
}  // namespace roomgraph::test
