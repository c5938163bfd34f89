// SPDX-License-Identifier: BSD-3-Clause
// Simulated drive around a circle with noisy movements, sightings and one loop closure.
#pragma once

#include <cmath>
#include <vector>

#include "random_poses.h"
#include "roomgraph/backend/factor_graph.h"

namespace roomgraph::test {

/// Standard normal number (Box-Muller), the same on every platform.
inline double gauss(Random& random) {
  const double u = random.uniform(1e-9, 1), v = random.uniform(0, 2 * M_PI);
  return std::sqrt(-2 * std::log(u)) * std::cos(v);
}

/// A robot drives once round a circle of 2 m radius; three objects stand inside. Movements, sightings and one
/// loop closure carry Gaussian noise of exactly the covariance that the factors claim.
class SimulatedLoop {
 public:
  explicit SimulatedLoop(unsigned seed, int poses = 24) : random_(seed) {
    for (int i = 0; i < poses; ++i) {
      const double angle = 2 * M_PI * i / poses;
      truth_.push_back(poseFromYpr(2 * std::cos(angle), 2 * std::sin(angle), 0, angle + M_PI / 2, 0, 0));
    }
    objects_ = {{{0.5, 0.3, 0}, 0.4}, {{-0.7, 0.2, 0}, 2.8}, {{0.1, -0.9, 0}, -1.5}};
  }

  const std::vector<Pose3>& truth() const { return truth_; }
  const std::vector<LandmarkEstimate>& objects() const { return objects_; }
  int size() const { return static_cast<int>(truth_.size()); }

  BetweenFactor movement(int a, int b, double sigma_m = 0.03, double sigma_rad = 0.01) {
    BetweenFactor factor{NodeId{a}, NodeId{b}};
    Vector6d sigma, noise;
    sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
    for (int i = 0; i < 6; ++i) noise[i] = sigma[i] * gauss(random_);
    factor.a_from_b = at(a).inverse() * at(b);
    factor.a_from_b.translation() += noise.head<3>();
    factor.a_from_b.linear() = factor.a_from_b.linear() * expSO3(noise.tail<3>());
    factor.covariance = sigma.cwiseAbs2().asDiagonal();
    return factor;
  }

  LandmarkFactor sighting(int node, int object, bool has_yaw = true) {
    const LandmarkEstimate& seen = objects_[static_cast<std::size_t>(object)];
    LandmarkFactor factor{NodeId{node}, LandmarkId{object}};
    factor.has_yaw = has_yaw;
    factor.robust_width = 0;
    const Eigen::Vector4d sigma(0.05, 0.03, 0.04, 0.1);
    factor.position_in_robot = at(node).inverse() * seen.position;
    for (int i = 0; i < 3; ++i) factor.position_in_robot[i] += sigma[i] * gauss(random_);
    factor.yaw_in_robot = wrapAngle(seen.yaw - planarPart(at(node)).yaw + sigma[3] * gauss(random_));
    factor.covariance = sigma.cwiseAbs2().asDiagonal();
    return factor;
  }

  /// All of it. Poses start from the summed movements, objects from where the first pose would put them.
  FactorGraph graph() {
    FactorGraph graph;
    Pose3 guess = truth_.front();
    std::vector<BetweenFactor> movements;
    for (int i = 0; i + 1 < size(); ++i) movements.push_back(movement(i, i + 1));
    for (int i = 0; i < size(); ++i) {
      graph.addPose(NodeId{i}, guess, i == 0);
      if (i + 1 < size()) guess = guess * movements[static_cast<std::size_t>(i)].a_from_b;
    }
    for (const auto& m : movements) graph.add(m);
    graph.add(movement(size() - 1, 0));
    for (int k = 0; k < static_cast<int>(objects_.size()); ++k) {
      graph.addLandmark(LandmarkId{k}, {truth_.front() * sighting(0, k).position_in_robot, 0});
      for (int i = 0; i < size(); i += 2) graph.add(sighting(i, k));
    }
    return graph;
  }

  double meanPoseError(const FactorGraph& graph) const {
    double sum = 0;
    for (int i = 0; i < size(); ++i)
      sum += (graph.pose(NodeId{i}).translation() - at(i).translation()).norm();
    return sum / size();
  }

 private:
  const Pose3& at(int i) const { return truth_[static_cast<std::size_t>(i)]; }

  Random random_;
  std::vector<Pose3> truth_;
  std::vector<LandmarkEstimate> objects_;
};

}  // namespace roomgraph::test
