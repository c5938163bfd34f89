// SPDX-License-Identifier: BSD-3-Clause
// Pose refinement and RANSAC: exact pose, outliers, and covariance by Monte Carlo.
#include "pose_solver.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph::tracking {
namespace {

/// Points in front of a camera with known pose, seen with pixel noise; every third one wrong when asked for.
struct Scene {
  PoseProblem problem;
  Pose3 camera_from_world = poseFromYpr(0.2, -0.1, 0.3, 0.15, -0.2, 0.1);

  Scene(unsigned seed, double noise_px, bool with_outliers) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::normal_distribution<double> normal;
    problem.camera = {640, 480, 525, 525, 320, 240, {}};
    TrackingParameters parameters;
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d in_camera(1.2 * unit(random), 0.9 * unit(random), 3 + 1.5 * unit(random));
      Eigen::Vector2d pixel = problem.camera.project(in_camera);
      pixel += noise_px * Eigen::Vector2d(normal(random), normal(random));
      double depth = in_camera.z() + 0.0025 * in_camera.z() * in_camera.z() * noise_px * normal(random);
      if (with_outliers && i % 3 == 0) pixel += Eigen::Vector2d(60 + 40 * unit(random), 50 * unit(random));
      if (with_outliers && i % 3 == 1 && i % 2) depth += 1;
      problem.points.push_back(camera_from_world.inverse() * in_camera);
      problem.observations.push_back(makeObservation(pixel, 0, depth, parameters));
    }
  }
};

double translationError(const Pose3& a, const Pose3& b) {
  return (a.inverse() * b).translation().norm();
}

TEST(PoseSolver, RecoversTheExactPose) {
  const Scene scene(1, 0, false);
  const auto solution = refinePose(scene.problem, Pose3::Identity());
  EXPECT_EQ(solution.inliers, 150);
  EXPECT_LT(translationError(solution.camera_from_world, scene.camera_from_world), 1e-6);
  EXPECT_LT(rotationAngle(solution.camera_from_world.inverse() * scene.camera_from_world), 1e-6);
}

TEST(PoseSolver, ShrugsOffWrongPixelsAndDepths) {
  const Scene scene(2, 0.5, true);
  const Pose3 start = poseFromYpr(0.02, 0.02, 0.02, 0.02, 0.02, 0.02) * scene.camera_from_world;
  const auto solution = refinePose(scene.problem, start);
  EXPECT_LT(translationError(solution.camera_from_world, scene.camera_from_world), 0.01);
  for (std::size_t i = 0; i < solution.inlier.size(); i += 3) EXPECT_FALSE(solution.inlier[i]) << i;
}

TEST(PoseSolver, RansacNeedsNoStart) {
  const Scene scene(3, 0.5, true);
  const auto solution = ransacPose(scene.problem, 20);
  ASSERT_GE(solution.inliers, 60);
  EXPECT_LT(translationError(solution.camera_from_world, scene.camera_from_world), 0.01);
  EXPECT_EQ(ransacPose(scene.problem, 20).camera_from_world.matrix(), solution.camera_from_world.matrix());
}

TEST(PoseSolver, RansacSaysWhenThereIsNoPose) {
  Scene scene(4, 0, false);
  std::mt19937 random(4);
  std::shuffle(scene.problem.points.begin(), scene.problem.points.end(), random);
  EXPECT_LT(ransacPose(scene.problem, 40).inliers, 40);
}

// Of a linear problem the optimum is the mean of both by their information.
TEST(PoseSolver, APriorIsOneMoreMeasurement) {
  Scene scene(5, 0, false);
  scene.problem.prior = PosePrior{scene.camera_from_world, 0.02, 0.01};
  PoseProblem unseen = scene.problem;
  unseen.points.clear();
  unseen.observations.clear();
  const Pose3 start = poseFromYpr(0.03, -0.02, 0.01, 0.02, 0.01, 0) * scene.camera_from_world;
  EXPECT_TRUE(refinePose(unseen, start).camera_from_world.isApprox(scene.camera_from_world, 1e-6)) << "by the prior alone";
  const auto by_both = refinePose(scene.problem, scene.camera_from_world);

  Vector6d off;
  off << 4e-4, -3e-4, 2e-4, 1e-4, -2e-4, 1e-4;
  scene.problem.prior->camera_from_world = leftPerturbation(off) * scene.camera_from_world;
  const Matrix6d both = by_both.covariance.inverse();
  Matrix6d prior = Matrix6d::Zero();
  prior.diagonal() << Eigen::Vector3d::Constant(1 / (0.02 * 0.02)), Eigen::Vector3d::Constant(1 / (0.01 * 0.01));
  const Vector6d expected = both.ldlt().solve(Vector6d(prior * off));
  const Pose3 moved = refinePose(scene.problem, scene.camera_from_world).camera_from_world * scene.camera_from_world.inverse();
  Vector6d found;
  found << moved.translation(), logSO3(moved.linear());
  EXPECT_LT((found - expected).norm(), 0.02 * expected.norm()) << found.transpose() << "; " << expected.transpose();
}

TEST(PoseSolver, DeviationsAreThoseOfBoth) {
  const PosePrior prior{poseFromYpr(1, 2, 3, 0.4, 0.5, 0.6), 0.01, 0.02};
  PoseSolution solution;
  Vector6d off;
  off << 0.03, 0, 0, 0, 0.08, 0;
  solution.camera_from_world = leftPerturbation(off) * prior.camera_from_world;
  solution.covariance.setZero();
  EXPECT_NEAR(prior.deviation(solution.camera_from_world)[0], 3, 1e-9);
  EXPECT_NEAR(prior.deviation(solution.camera_from_world)[4], 4, 1e-9);
  EXPECT_NEAR(deviationFrom(prior, solution), 5, 1e-9);
  solution.covariance.diagonal() << Eigen::Vector3d::Constant(3e-4), Eigen::Vector3d::Constant(12e-4);
  EXPECT_NEAR(deviationFrom(prior, solution), 2.5, 1e-9) << "four times the variance";
}

TEST(PoseSolver, PixelErrorsAreInStandardDeviations) {
  PoseProblem problem{{640, 480, 500, 500, 320, 240, {}}, {}, {}};
  const TrackingParameters parameters;
  for (const auto& [aside, depth, behind] : {std::tuple(3.0, 2.0, false), {0.0, 4.0, false}, {0.0, 2.0, true}}) {
    problem.points.emplace_back(0, 0, behind ? -2 : 2);
    problem.observations.push_back(makeObservation({320 + aside, 240}, 0, depth, parameters));
  }
  const auto errors = pixelErrors(problem, Pose3::Identity());
  EXPECT_NEAR(errors[0], 9 / (parameters.pixel_sigma_px * parameters.pixel_sigma_px), 1e-9);
  EXPECT_TRUE(std::isinf(errors[1])) << "another surface";
  EXPECT_TRUE(std::isinf(errors[2])) << "behind the camera";
  EXPECT_TRUE(agrees(5.9));
  EXPECT_FALSE(agrees(6.1));
}

TEST(PoseSolver, CovarianceFitsTheErrorsThatOccur) {
  double normalized_error = 0;
  const int rounds = 40;
  for (int round = 0; round < rounds; ++round) {
    const Scene scene(100 + static_cast<unsigned>(round), 1.0, false);  // the noise the parameters assume
    const auto solution = refinePose(scene.problem, scene.camera_from_world);
    const Pose3 error = solution.camera_from_world * scene.camera_from_world.inverse();
    Vector6d e;
    e << error.translation(), logSO3(error.linear());
    normalized_error += e.dot(solution.covariance.ldlt().solve(e)) / 6;
  }
  EXPECT_GT(normalized_error / rounds, 0.5);
  EXPECT_LT(normalized_error / rounds, 2.0);
}

}  // namespace
}  // namespace roomgraph::tracking
