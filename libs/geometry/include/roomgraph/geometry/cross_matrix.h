// SPDX-License-Identifier: BSD-3-Clause
// Cross product with a vector as a matrix.
#pragma once

#include <Eigen/Core>

namespace roomgraph {

/// Times w: v x w.
inline Eigen::Matrix3d crossing(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

}  // namespace roomgraph
