// SPDX-License-Identifier: BSD-3-Clause
// Portable random numbers, vectors and poses for tests.
#pragma once

#include <random>

#include "roomgraph/geometry/pose.h"

namespace roomgraph::test {

/// Numbers and poses from a fixed seed. std::uniform_real_distribution may differ between standard libraries,
/// so the numbers come straight from the generator.
class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_()) / 4294967296.0);
  }
  int index(int count) { return static_cast<int>(generator_() % static_cast<unsigned>(count)); }
  Eigen::Vector3d vector(double reach) {
    const double x = uniform(-reach, reach), y = uniform(-reach, reach), z = uniform(-reach, reach);
    return {x, y, z};
  }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v = vector(1);
    while (v.norm() < 0.1 || v.norm() > 1) v = vector(1);
    return v.normalized();
  }
  /// Rotation by an angle up to max_angle about a random axis.
  Pose3 pose(double reach, double max_angle = 3.1) {
    Pose3 out = Pose3::Identity();
    const Eigen::Vector3d axis = direction();
    out.linear() = Eigen::AngleAxisd(uniform(-max_angle, max_angle), axis).toRotationMatrix();
    out.translation() = vector(reach);
    return out;
  }

 private:
  std::mt19937 generator_;
};

}  // namespace roomgraph::test
