// SPDX-License-Identifier: BSD-3-Clause
// Brute-force ray casting over all triangles of a scene: the reference of raster and lidar tests.
#pragma once

#include <limits>

#include "scene.h"

namespace roomgraph::test {

struct RayHit {
  double distance = std::numeric_limits<double>::infinity();  ///< in lengths of the direction
  double second = std::numeric_limits<double>::infinity();    ///< of the next surface behind it
  int object = -1;                                            ///< index of Scene::objects(), -1: building or nothing
};

/// First surface on the ray from `origin` along `direction` (world), by solving origin + d * direction =
/// a + u (b - a) + v (c - a) for every triangle.
inline RayHit firstHit(const Scene& scene, const std::vector<Pose3>& world_from_part, const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction) {
  RayHit out;
  for (std::size_t i = 0; i < scene.parts().size(); ++i) {
    for (const auto& triangle : scene.parts()[i].mesh.triangles) {
      Eigen::Vector3d p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = world_from_part[i] * triangle.position[k].cast<double>();
      Eigen::Matrix3d system;
      system << -direction, p[1] - p[0], p[2] - p[0];
      if (std::abs(system.determinant()) < 1e-14) continue;
      const Eigen::Vector3d x = system.inverse() * (origin - p[0]);
      if (x[0] <= 0 || x[1] < -1e-9 || x[2] < -1e-9 || x[1] + x[2] > 1 + 1e-9) continue;
      if (x[0] < out.distance) {
        if (out.distance - x[0] > 1e-9) out.second = out.distance;
        out.distance = x[0];
        out.object = scene.parts()[i].object;
      } else if (x[0] - out.distance > 1e-9) {
        out.second = std::min(out.second, x[0]);
      }
    }
  }
  return out;
}

}  // namespace roomgraph::test
