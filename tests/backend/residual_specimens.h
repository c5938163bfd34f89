// SPDX-License-Identifier: BSD-3-Clause
// Specimens of cost functions: states with known residuals, for every factor type.
#pragma once

#include <ceres/ceres.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "costs.h"
#include "planar_residual.h"
#include "random_poses.h"

namespace roomgraph::test {

/// One parameter block; a quaternion (x y z w) moves on its manifold, others in a plain vector space.
struct Block {
  std::vector<double> value;
  bool quaternion = false;
};

/// A cost function with a state at which something is known about its residuals.
struct Specimen {
  std::shared_ptr<ceres::CostFunction> cost;
  std::vector<Block> blocks;
  std::vector<double> residuals = {};  ///< expected at `blocks`
};

/// A measurement type in the list of tests.
struct ResidualCase {
  std::string name;
  std::function<Specimen(Random&)> at_measurement;  ///< a random measurement with the state it is exact for
  std::function<Specimen()> by_hand;                ///< a state whose residuals were worked out on paper
};

/// What must be known about each kind of measurement to be tested: kName, atMeasurement(Random&), byHand(),
/// as in ResidualCase. There is no general definition: a kind of factor that is added to the list `Factor` of
/// the library without its own specimens here does not compile.
template <class Measurement>
struct SpecimenOf;

template <class... Arguments>
std::shared_ptr<ceres::CostFunction> sharedCost(const Arguments&... arguments) {
  return std::shared_ptr<ceres::CostFunction>(costOf(arguments...));
}

inline void append(std::vector<Block>& blocks, const Pose3& pose) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  blocks.push_back({{t.x(), t.y(), t.z()}});
  blocks.push_back({{q.x(), q.y(), q.z(), q.w()}, true});
}

inline std::vector<Block> blocksOf(const Pose3& pose) {
  std::vector<Block> blocks;
  append(blocks, pose);
  return blocks;
}

/// A full, well-conditioned covariance.
template <int N>
Eigen::Matrix<double, N, N> randomCovariance(Random& random) {
  Eigen::Matrix<double, N, N> root;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) root(i, j) = random.uniform(-0.3, 0.3);
  return root * root.transpose() + 0.05 * Eigen::Matrix<double, N, N>::Identity();
}

std::vector<ResidualCase> residualCases();

}  // namespace roomgraph::test
