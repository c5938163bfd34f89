// SPDX-License-Identifier: BSD-3-Clause
// Covariance of a refined plane against the spread over sampled clouds.
#include "plane_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roomgraph {
namespace {

// Points on a plane come in groups of 25 with one error along the normal, as neighbouring pixels share theirs. The
// plane's distance at any place is linear in (normal, offset), so its variance follows from the covariance, and can be
// sampled: it is least in the middle of the points, where tilt has no lever, and grows to the sides.
TEST(PlaneFit, CovarianceIsTheSpreadOverSampledClouds) {
  constexpr int kGroups = 12, kGroupSize = 25, kRuns = 300;
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.8, -0.59).normalized(), middle(0.3, 0.9, 4);
  const Eigen::Vector3d across = normal.unitOrthogonal(), along = normal.cross(across);
  const Plane truth{normal, -normal.dot(middle)};
  std::mt19937 random(12);
  std::uniform_real_distribution<double> within(-0.6, 0.6);
  std::normal_distribution<double> gauss;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kGroups; ++i) places.push_back(middle + within(random) * across + within(random) * along);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& place : places) mean += place / kGroups;
  const std::vector<Eigen::Vector3d> probes{mean, mean + 0.5 * along};
  std::vector<double> squares(probes.size()), claimed(probes.size());
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& place : places) {
      const double error = depthSigma(place.z()) * gauss(random);
      for (int i = 0; i < kGroupSize; ++i)
        points.push_back(place + error * normal + 0.03 * (within(random) * across + within(random) * along));
    }
    const RefinedPlane found = refinePlane(truth, points);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      const Eigen::Vector4d row = probes[i].homogeneous();
      squares[i] += std::pow(found.plane.distance(probes[i]), 2) / kRuns;
      claimed[i] += row.dot(found.covariance * row) / kRuns;
    }
  }
  // More is claimed than the samples spread: 4 mm on top of depth noise, and what calibration leaves (0.003 rad, 5 mm).
  for (std::size_t i = 0; i < probes.size(); ++i) {
    EXPECT_GT(claimed[i], 0.8 * squares[i]) << i;
    EXPECT_LT(claimed[i], 2.6 * squares[i]) << i;
  }
}

}  // namespace
}  // namespace roomgraph
