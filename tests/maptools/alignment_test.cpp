// SPDX-License-Identifier: BSD-3-Clause
// The frame of one map in another: known transforms found, unsure ones refused.
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "roomgraph/maptools/map_alignment.h"
#include "two_sessions.h"
#include "wall_evidence.h"

namespace roomgraph {
namespace {

using test::objectAt;
using test::sessionMap;
using ::testing::HasSubstr;

TEST(MapAlignment, FindsKnownTransformsAlthoughThingsChanged) {
  const auto objects = test::flatObjects();
  const CSemanticMap a = sessionMap(test::flatWalls(), objects, {0.4, -1.1, 0.2});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-3, 3), turn(-3.1, 3.1);
  for (int i = 0; i < 4; ++i) {
    auto later = objects;
    later.erase(later.begin() + i);
    later[0].position += Eigen::Vector3d(1.5, 1.2, 0);
    const Pose2 b_from_world{shift(random), shift(random), turn(random)};
    const CSemanticMap b = sessionMap(test::flatWalls(), later, b_from_world);
    const auto found = alignMaps(a, b);
    ASSERT_TRUE(found) << found.reason();
    const Pose2 error = found->a_from_b * b_from_world * Pose2{0.4, -1.1, 0.2}.inverse();
    EXPECT_LT(std::hypot(error.x, error.y), 0.03);
    EXPECT_LT(std::abs(error.yaw), 0.01);
    EXPECT_GT(found->probability, 0.95);
    EXPECT_GE(found->pairs, 4);
    EXPECT_GT(found->explained, 0.9);
    EXPECT_GT(found->covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
    EXPECT_LT(std::sqrt(found->covariance(0, 0)), 0.1);
  }
}

TEST(MapAlignment, EnoughOfTheSmallerMapMustBeShared) {
  const CSemanticMap a = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0}, 0,
                                    [](const Eigen::Vector2d& p) { return p.x() > 6; });
  const CSemanticMap b = sessionMap(test::flatWalls(), test::flatObjects(), {1, 2, 0.5}, 0,
                                    [](const Eigen::Vector2d& p) { return p.x() < 1; });
  const auto found = alignMaps(a, b);
  ASSERT_TRUE(found) << found.reason();
  EXPECT_NEAR(found->overlap, 5.0 / 6, 0.05) << "5 m of 6 m";
  MapAlignmentOptions strict;
  strict.least_overlap = 0.95;
  EXPECT_FALSE(alignMaps(a, b, strict));
}

TEST(MapAlignment, WallsAloneSuffice) {
  const CSemanticMap a = sessionMap(test::flatWalls(), {}, {0, 0, 0}),
                     b = sessionMap(test::flatWalls(), {}, {2, 1, -2.5});
  const auto found = alignMaps(a, b);
  ASSERT_TRUE(found) << found.reason();
  EXPECT_NEAR(found->a_from_b.yaw, 2.5, 0.01);
}

TEST(MapAlignment, SameFrameIsTakenAsItIs) {
  const CSemanticMap a = sessionMap(test::flatWalls(), test::flatObjects(), {1, 0, 0.3});
  MapAlignmentOptions options;
  options.same_frame = true;
  const auto found = alignMaps(a, a, options);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->a_from_b.x, 0);
  EXPECT_EQ(found->pairs, 6);
  EXPECT_EQ(found->explained, 1);
}

TEST(MapAlignment, AmbiguousIsRefused) {
  const CSemanticMap a = sessionMap(test::squareWalls(), {}, {0, 0, 0}),
                     b = sessionMap(test::squareWalls(), {}, {1, 2, 0.4});
  const auto found = alignMaps(a, b);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.reason(), HasSubstr("ambiguous"));
  // Objects break the symmetry.
  const std::vector<Landmark> objects{objectAt(1, "swivel_chair", 1, 1), objectAt(2, "swivel_chair", 5, 2),
                                      objectAt(3, "sofa", 3, 5.4, -1.57)};
  const auto broken = alignMaps(sessionMap(test::squareWalls(), objects, {0, 0, 0}),
                                sessionMap(test::squareWalls(), objects, {1, 2, 0.4}));
  ASSERT_TRUE(broken) << broken.reason();
  EXPECT_NEAR(broken->a_from_b.yaw, -0.4, 0.01);
}

TEST(MapAlignment, AnotherFlatIsRefused) {
  const CSemanticMap a = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0});
  for (const double turn : {0.0, 1.0, 2.5}) {
    const std::vector<Landmark> objects{objectAt(1, "swivel_chair", 1, 2.4),
                                        objectAt(2, "swivel_chair", 4.2, 7.7),
                                        objectAt(3, "sofa", 4.3, 4, 3.1)};
    const auto found = alignMaps(a, sessionMap(test::otherWalls(), objects, {0, 1, turn}));
    EXPECT_FALSE(found) << "moved by " << found->a_from_b.x << " " << found->a_from_b.y;
  }
  EXPECT_FALSE(alignMaps(a, CSemanticMap()));
  EXPECT_FALSE(alignMaps(CSemanticMap(), CSemanticMap()));
}

TEST(MapAlignment, WithoutGridsFourObjectsAreNeeded) {
  CSemanticMap a = sessionMap(test::flatWalls(), test::flatObjects(), {0, 0, 0});
  CSemanticMap b = sessionMap(test::flatWalls(), test::flatObjects(), {1, 1, 1});
  a.occupancy.reset();
  const auto found = alignMaps(a, b);
  ASSERT_TRUE(found) << found.reason();
  EXPECT_NEAR(found->a_from_b.yaw, -1, 1e-6);
  b.landmarks.resize(3);
  EXPECT_FALSE(alignMaps(a, b));
}

TEST(MapAlignment, WallsCountWhereTheOtherMapSawSomething) {
  const auto half = [](const Eigen::Vector2d& p) { return p.x() > 3.5; };
  const CSemanticMap a = sessionMap(test::flatWalls(), {}, {0, 0, 0}, 0, half),
                     b = sessionMap(test::flatWalls(), {}, {0, 0, 0});
  const WallGrid walls_a(*a.occupancy), walls_b(*b.occupancy);
  const auto right = walls_a.agreement(walls_b.points(), {0, 0, 0});
  EXPECT_GT(right.explained_m, 15);
  EXPECT_EQ(right.contradicted_m, 0);
  EXPECT_GT(right.evidence, 0);
  const auto beside = walls_a.agreement(walls_b.points(), {0.4, 0.3, 0});
  EXPECT_GT(beside.contradicted_m, 5);
  EXPECT_LT(beside.evidence, right.evidence - 5);
}

// Against sampled transforms: what the covariance of a moved object should be.
TEST(MapAlignment, MovedObjectsHaveTheTransformsUncertainty) {
  CSemanticMap b;
  b.landmarks = {objectAt(1, "sofa", 4, -2, 0.3)};
  b.landmarks[0].covariance = Eigen::Vector4d(0.01, 0.0025, 0.0004, 0.0009).asDiagonal();
  MapAlignment alignment;
  alignment.a_from_b = {1, 2, 0.7};
  alignment.covariance = Eigen::Vector3d(0.0016, 0.0036, 0.0004).asDiagonal();
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const Eigen::Vector2d mean = alignment.a_from_b * Eigen::Vector2d(4, -2);
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const Pose2 pose{1 + 0.04 * normal(random), 2 + 0.06 * normal(random), 0.7 + 0.02 * normal(random)};
    const Eigen::Vector2d at = pose * Eigen::Vector2d(4 + 0.1 * normal(random), -2 + 0.05 * normal(random));
    const Eigen::Vector3d error(at.x() - mean.x(), at.y() - mean.y(), pose.yaw + 0.03 * normal(random) - 0.7);
    sum += error * error.transpose() / kSamples;
  }
  const CSemanticMap moved = movedMap(b, alignment, nullptr);
  const Eigen::Matrix4d& covariance = moved.landmarks[0].covariance;
  const int axes[3] = {0, 1, 3};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(covariance(axes[i], axes[j]), sum(i, j), 4e-4) << i << j;
  EXPECT_NEAR(moved.landmarks[0].position.x(), mean.x(), 1e-12);
  EXPECT_NEAR(moved.landmarks[0].yaw, 1.0, 1e-12);
}

TEST(MapAlignment, MovedGridShowsTheSameWallsOnTheOtherLattice) {
  const CSemanticMap a = sessionMap(test::flatWalls(), {}, {0.013, 0.02, 0});
  CSemanticMap b = sessionMap(test::flatWalls(), {}, {2, 1, 0.8});
  KeyView view;
  view.world_from_camera = b.world_from_robot[2].pose;
  b.views = {view};
  MapAlignment alignment;
  alignment.a_from_b = Pose2{0.013, 0.02, 0} * Pose2{2, 1, 0.8}.inverse();
  const CSemanticMap moved = movedMap(b, alignment, a.occupancy.get());
  const double steps = (moved.occupancy->getXMin() - a.occupancy->getXMin()) / 0.05;
  EXPECT_NEAR(steps, std::round(steps), 1e-3);
  for (const auto& point : wallPoints(*moved.occupancy, 0.05)) {
    double nearest = 1e9;
    for (const auto& wall : test::flatWalls())
      nearest = std::min(nearest, test::distanceToWall(point - Eigen::Vector2d(0.013, 0.02), wall));
    EXPECT_LT(nearest, 0.05 + 0.036) << "half a cell's diagonal farther than drawn";
  }
  EXPECT_NEAR(moved.world_from_robot[2].pose.translation().x(), 3.013, 1e-9);
  EXPECT_TRUE(moved.views.at(0).world_from_camera.isApprox(moved.world_from_robot[2].pose, 1e-9));
}

}  // namespace
}  // namespace roomgraph
