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
