// SPDX-License-Identifier: BSD-3-Clause
// Bundle adjustment by the Schur complement against Ceres with automatic derivatives, on made-up scenes.
#include "sparse_bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

namespace roomgraph::tracking {
namespace {

constexpr double kHuber = 2;

/// Noisy sightings, some without depth and some grossly wrong, of points before cameras on a line; the state is off.
SparseBundle madeUpScene(unsigned seed, int cameras, int points) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  SparseBundle bundle;
  for (int c = 0; c < cameras; ++c) {
    BundleCamera camera{{640, 480, 520, 525, 318, 242, {}}, poseFromYpr(-0.2 * c, 0.03 * c, 0.1, 0.05 * unit(random), 0.1 * unit(random), 0.02), c >= 2};
    bundle.cameras.push_back(camera);
  }
  for (int p = 0; p < points; ++p) {
    BundlePoint point{{1.2 * unit(random), 0.9 * unit(random), 3 + unit(random)}, {}};
    for (int c = 0; c < cameras; ++c) {
      if (unit(random) > 0.6) continue;
      const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(c)];
      const Eigen::Vector3d in_camera = camera.camera_from_odom * point.position;
      Observation seen{camera.intrinsics.project(in_camera), unit(random) > 0 ? 1.0 : 1.44, in_camera.z(), 0.02};
      seen.pixel += seen.pixel_sigma * Eigen::Vector2d(normal(random), normal(random));
      seen.depth += seen.depth_sigma * normal(random);
      if (unit(random) > 0.7) seen.depth = 0;
      if (unit(random) > 0.9) seen.pixel.x() += 25;
      point.terms.push_back({c, seen});
    }
    if (point.terms.size() < 2) continue;
    point.position += 0.02 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    bundle.points.push_back(point);
  }
  for (BundleCamera& camera : bundle.cameras)
    if (camera.moves) camera.camera_from_odom = poseFromYpr(0.02, -0.01, 0.015, 0.01, -0.01, 0.008) * camera.camera_from_odom;
  return bundle;
}

struct TermCost {
  PinholeCamera camera;
  Observation observation;
  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
    reprojectionResidual(camera, observation, p, residual);
    return true;
  }
};

/// The same minimum by Ceres; also its cost.
SparseBundle minimumByCeres(SparseBundle bundle, double& cost) {
  ceres::Problem problem;
  std::vector<std::array<double, 6>> blocks(bundle.cameras.size());
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    const Pose3& pose = bundle.cameras[c].camera_from_odom;
    const Eigen::Vector3d r = logSO3(pose.linear()), t = pose.translation();
    blocks[c] = {r.x(), r.y(), r.z(), t.x(), t.y(), t.z()};
  }
  for (BundlePoint& point : bundle.points)
    for (const BundleTerm& term : point.terms) {
      const auto c = static_cast<std::size_t>(term.camera);
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TermCost, 3, 6, 3>(new TermCost{bundle.cameras[c].intrinsics, term.observation}),
                               new ceres::HuberLoss(kHuber), blocks[c].data(), point.position.data());
    }
  for (std::size_t c = 0; c < blocks.size(); ++c)
    if (!bundle.cameras[c].moves && problem.HasParameterBlock(blocks[c].data())) problem.SetParameterBlockConstant(blocks[c].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  cost = summary.final_cost;
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    Pose3& pose = bundle.cameras[c].camera_from_odom;
    pose.linear() = expSO3({blocks[c][0], blocks[c][1], blocks[c][2]});
    pose.translation() << blocks[c][3], blocks[c][4], blocks[c][5];
  }
  return bundle;
}

class SparseBundleTest : public testing::TestWithParam<unsigned> {};

TEST_P(SparseBundleTest, FindsTheMinimumThatCeresFinds) {
  SparseBundle bundle = madeUpScene(GetParam(), 6, 150);
  double expected = 0;
  const SparseBundle reference = minimumByCeres(bundle, expected);
  ASSERT_NEAR(costOf(reference, kHuber), expected, 1e-9 * expected);
  ASSERT_TRUE(adjust(bundle, {200, kHuber, 1e-13}));
  EXPECT_NEAR(costOf(bundle, kHuber), expected, 1e-6 * expected);
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const Pose3 error = reference.cameras[c].camera_from_odom.inverse() * bundle.cameras[c].camera_from_odom;
    EXPECT_LT(error.translation().norm(), 1e-4) << c;
    EXPECT_LT(rotationAngle(error), 1e-4) << c;
  }
}

TEST_P(SparseBundleTest, LeavesGivenPosesAndNeverGetsWorse) {
  SparseBundle bundle = madeUpScene(GetParam(), 5, 60);
  const SparseBundle start = bundle;
  double cost = costOf(bundle, kHuber);
  for (int step = 0; step < 5; ++step) {
    ASSERT_TRUE(adjust(bundle, {1, kHuber, 0}));
    EXPECT_LE(costOf(bundle, kHuber), cost);
    cost = costOf(bundle, kHuber);
  }
  EXPECT_LT(cost, 0.5 * costOf(start, kHuber));
  for (std::size_t c = 0; c < 2; ++c)
    EXPECT_TRUE(bundle.cameras[c].camera_from_odom.isApprox(start.cameras[c].camera_from_odom, 0));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SparseBundleTest, testing::Range(1U, 9U));

TEST(SparseBundle, LeavesAPointBehindACameraAlone) {
  SparseBundle bundle = madeUpScene(1, 4, 40);
  bundle.points[3].position.z() = -5;
  const Eigen::Vector3d before = bundle.points[5].position;
  EXPECT_FALSE(adjust(bundle, {6, kHuber, 1e-4}));
  EXPECT_EQ(bundle.points[5].position, before);
}

}  // namespace
}  // namespace roomgraph::tracking
