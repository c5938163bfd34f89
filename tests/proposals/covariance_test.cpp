// SPDX-License-Identifier: BSD-3-Clause
// Proposal covariance: shape, growth, and Monte Carlo over tilt and box noise.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "proposal_covariance.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

PlacedShape chairAt(double x, double y) {
  PlacedShape placed;
  placed.shape = database().find("swivel_chair")->nominal();
  placed.x = x;
  placed.y = y;
  placed.quality = 0.95;
  return placed;
}

BoxEvidence seen(bool depth) {
  BoxEvidence e;
  e.model = database().find("swivel_chair");
  e.ground.offset = 0.8;
  e.camera = {640, 480, 525, 525, 319.5, 239.5, {}};
  e.box = {300, 200, 340, 300};
  if (depth) e.mask.points.resize(200);
  return e;
}

TEST(Covariance, IsLongestAlongTheViewAndGrowsWithDistance) {
  for (const bool depth : {true, false}) {
    double before = 0;
    for (const double range : {1.5, 2.5, 4.0}) {
      const Eigen::Vector2d ahead = Eigen::Vector2d(0.8, 0.6);
      const Eigen::Matrix4d c = covarianceOf(chairAt(range * 0.8, range * 0.6), seen(depth), 0.01);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(Eigen::Matrix2d(c.topLeftCorner<2, 2>()));
      EXPECT_GT(std::abs(eigen.eigenvectors().col(1).dot(ahead)), 0.999);
      EXPECT_GT(eigen.eigenvalues()(0), 0);
      EXPECT_GT(eigen.eigenvalues()(1), before);
      before = eigen.eigenvalues()(1);
    }
  }
}

TEST(Covariance, PoorFitCutBoxAndMissingDepthMakeItLarger) {
  const PlacedShape good = chairAt(2.5, 0);
  const Eigen::Matrix4d whole = covarianceOf(good, seen(true), 0.01);
  const double usual = whole(0, 0);
  PlacedShape poor = good;
  poor.quality = 0.6;
  EXPECT_GT(covarianceOf(poor, seen(true), 0.01)(0, 0), 2 * usual);
  BoxEvidence cut = seen(true);
  cut.cut.left = true;
  EXPECT_GT(covarianceOf(good, cut, 0.01)(1, 1), 2 * whole(1, 1)) << "across the view: the box's middle is not the object's";
  EXPECT_GT(covarianceOf(good, cut, 0.01)(0, 0), 1.2 * usual);
  BoxEvidence feet_hidden = seen(true);
  feet_hidden.cut.bottom = true;
  EXPECT_GT(covarianceOf(good, feet_hidden, 0.01)(0, 0), 1.2 * usual);
  EXPECT_EQ(covarianceOf(good, feet_hidden, 0.01)(1, 1), whole(1, 1)) << "across the view the bottom side says nothing";
  EXPECT_GT(covarianceOf(good, seen(false), 0.01)(0, 0), usual);
  PlacedShape unsupported = good;
  unsupported.supported = false;
  EXPECT_EQ(covarianceOf(unsupported, seen(true), 0.01)(0, 0), covarianceOf(good, seen(false), 0.01)(0, 0));
}

// What a wrong pitch does to the intersection with the ground (paper Eq. 2), by sampling.
TEST(Covariance, WithoutDepthItContainsTheGroundsTilt) {
  constexpr double kTilt = 0.01;
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, kTilt);
  for (const double range : {2.0, 3.5}) {
    const Plane ground{{0, -1, 0}, 0.8};
    const Eigen::Vector3d ray(0, 0.8, range);
    double sum = 0, squares = 0;
    constexpr int kRuns = 4000;
    for (int i = 0; i < kRuns; ++i) {
      const Plane tilted{expSO3({normal(random), 0, 0}) * ground.normal, ground.offset};
      const double z = intersect(ray, tilted).value().z();
      sum += z;
      squares += z * z;
    }
    const double sampled = squares / kRuns - std::pow(sum / kRuns, 2);
    const double difference = covarianceOf(chairAt(range, 0), seen(false), kTilt)(0, 0) -
                              covarianceOf(chairAt(range, 0), seen(false), 0)(0, 0);
    EXPECT_GT(difference, 0.8 * sampled) << range;
    EXPECT_LT(difference, 2.5 * sampled) << range;
  }
}

// What a wrong bottom side of the box does to it, by sampling.
TEST(Covariance, WithoutDepthItContainsTheBoxesNoise) {
  constexpr double kShare = 0.05;  // of the box's height
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  const Plane ground{{0, -1, 0}, 0.8};
  for (const double range : {2.0, 5.0}) {
    BoxEvidence high = seen(false), flat = high;
    flat.box.v_max = flat.box.v_min;
    double sum = 0, squares = 0;
    constexpr int kRuns = 4000;
    for (int i = 0; i < kRuns; ++i) {
      const double row = high.camera.cy + high.camera.fy * 0.8 / range;
      const auto ray = high.camera.ray(320, row + kShare * high.box.height() * normal(random));
      const double z = intersect(ray, ground).value().z();
      sum += z;
      squares += z * z;
    }
    const double sampled = squares / kRuns - std::pow(sum / kRuns, 2);
    const double difference =
        covarianceOf(chairAt(range, 0), high, 0)(0, 0) - covarianceOf(chairAt(range, 0), flat, 0)(0, 0);
    EXPECT_GT(difference, 0.8 * sampled) << range;
    EXPECT_LT(difference, 2.5 * sampled) << range;
  }
}

// Of a sofa one end is seen, its length is as uncertain as the class: what that does to the middle, by sampling.
TEST(Covariance, OfACuboidContainsWhatIsNotKnownOfItsSize) {
  BoxEvidence e = seen(true);
  e.model = database().find("sofa");
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.x = 2.5;
  placed.yaw = 2.2;
  placed.has_yaw = true;
  placed.quality = 0.95;
  const Eigen::Matrix2d sure = covarianceOf(placed, e, 0).topLeftCorner<2, 2>();
  placed.place_by_size(1, 0) = 0.5;
  std::mt19937 random(6);
  std::normal_distribution<double> length(0, e.model->width_sigma_m);
  Eigen::Matrix2d sampled = Eigen::Matrix2d::Zero();
  constexpr int kRuns = 20000;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::Vector2d moved = 0.5 * length(random) * Eigen::Vector2d(-std::sin(placed.yaw), std::cos(placed.yaw));
    sampled += moved * moved.transpose() / kRuns;
  }
  const Eigen::Matrix2d added = Eigen::Matrix2d(covarianceOf(placed, e, 0).topLeftCorner<2, 2>()) - sure;
  EXPECT_LT((added - sampled).norm(), 0.03 * sampled.norm());
  placed.size_information[0] = 3 / std::pow(e.model->width_sigma_m, 2);
  EXPECT_LT((Eigen::Matrix2d(covarianceOf(placed, e, 0).topLeftCorner<2, 2>()) - sure - added / 4).norm(), 1e-9)
      << "the image says three times what the class says";
}

}  // namespace
}  // namespace roomgraph
