// SPDX-License-Identifier: BSD-3-Clause
// Residual of a 2D edge in the error definition of g2o's EDGE_SE2.
#pragma once

#include "automatic_cost.h"
#include "residuals.h"
#include "roomgraph/backend/planar_graph.h"

namespace roomgraph {

/// Error of a PlanarEdge, whitened; poses are (x, y, yaw).
struct PlanarEdgeResidual {
  explicit PlanarEdgeResidual(const PlanarEdge& edge)
      : measured(edge.a_from_b), whitening(Eigen::LLT<Eigen::Matrix3d>(edge.information).matrixU()) {}

  template <class T>
  bool operator()(const T* a, const T* b, T* out) const {
    using std::cos, std::sin;
    const T ca = cos(a[2]), sa = sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
    const T x = ca * dx + sa * dy - measured.x, y = ca * dy - sa * dx - measured.y;
    const double c = std::cos(measured.yaw), s = std::sin(measured.yaw);
    const Vec3<T> error(c * x + s * y, c * y - s * x, angleDifference(T(b[2] - a[2]), T(measured.yaw)));
    Eigen::Map<Vec3<T>> whitened(out);
    whitened = whitening.cast<T>() * error;
    return true;
  }

  Pose2 measured;
  Eigen::Matrix3d whitening;
};

inline ceres::CostFunction* costOf(const PlanarEdge& edge) {
  return automatic<PlanarEdgeResidual, 3, 3, 3>(edge);
}

}  // namespace roomgraph
