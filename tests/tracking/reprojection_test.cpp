// SPDX-License-Identifier: BSD-3-Clause
// Reprojection residual and Jacobian against hand values and central differences.
#include "reprojection.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph::tracking {
namespace {

const PinholeCamera kCamera{640, 480, 500, 510, 320, 240, {}};

TEST(Reprojection, IsZeroAtTheMeasurement) {
  const Eigen::Vector3d p(0.3, -0.2, 2);
  const Observation exact{kCamera.project(p), 1.5, 2, 0.01};
  Eigen::Vector3d r;
  reprojectionResidual(kCamera, exact, p.data(), r.data());
  EXPECT_LT(r.norm(), 1e-12);
}

TEST(Reprojection, IsWhitenedAsComputedByHand) {
  const Eigen::Vector3d p(0.4, -0.2, 2);  // u = 500 * 0.2 + 320 = 420, v = 510 * -0.1 + 240 = 189
  const Observation observation{{417, 191}, 2, 1.9, 0.05};
  Eigen::Vector3d r;
  reprojectionResidual(kCamera, observation, p.data(), r.data());
  EXPECT_NEAR(r.x(), 3 / 2.0, 1e-12);
  EXPECT_NEAR(r.y(), -2 / 2.0, 1e-12);
  EXPECT_NEAR(r.z(), 0.1 / 0.05, 1e-9);
}

TEST(Reprojection, DepthNoiseGrowsWithSquaredDepth) {
  TrackingParameters parameters;
  parameters.depth_sigma_base_m = 0.001;
  parameters.depth_sigma_quadratic = 0.002;
  parameters.pixel_sigma_px = 0.5;
  parameters.scale_factor = 2;
  const auto observation = makeObservation({1, 2}, 3, 2, parameters);
  EXPECT_NEAR(observation.depth_sigma, 0.001 + 0.002 * 4, 1e-12);
  EXPECT_NEAR(observation.pixel_sigma, 0.5 * 8, 1e-12);
}

TEST(Reprojection, JacobianAgreesWithCentralDifferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Vector3d p(unit(random), unit(random), 2 + unit(random));
    const Observation observation{{300 + 50 * unit(random), 200}, 1.3, round % 4 ? 2.2 : 0, 0.02};
    const auto analytic = reprojectionJacobian(kCamera, observation, p);
    for (int i = 0; i < 6; ++i) {
      const double step = 1e-6;
      Eigen::Vector3d ends[2];
      for (int side = 0; side < 2; ++side) {
        Vector6d delta = Vector6d::Zero();
        delta[i] = side ? step : -step;
        const Eigen::Vector3d moved = leftPerturbation(delta) * p;
        reprojectionResidual(kCamera, observation, moved.data(), ends[side].data());
      }
      const Eigen::Vector3d numeric = (ends[1] - ends[0]) / (2 * step);
      EXPECT_LT((numeric - analytic.col(i)).norm(), 1e-4 * (1 + numeric.norm())) << "column " << i;
    }
  }
}

}  // namespace
}  // namespace roomgraph::tracking
