// SPDX-License-Identifier: BSD-3-Clause
// Ray-cast lidar scans of simple rooms with Gaussian noise.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "roomgraph/observations/scan.h"

namespace roomgraph::test {

struct Wall {
  Eigen::Vector2d from, to;
};

/// Ring of walls through the corners.
inline std::vector<Wall> ring(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Wall> walls;
  for (std::size_t i = 0; i < corners.size(); ++i)
    walls.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return walls;
}

/// Box of walls with its lower corner at (x, y).
inline std::vector<Wall> boxAt(double x, double y, double w, double h) {
  return ring({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
}

/// Room without any symmetry, about 8 m x 6 m, with two pieces of furniture.
inline std::vector<Wall> asymmetricRoom() {
  std::vector<Wall> walls = ring({{-3, -2}, {5, -2}, {5, 2.5}, {2, 2.5}, {2, 4}, {-3, 3}});
  for (const Wall& w : boxAt(-2.2, 1.4, 0.8, 0.5)) walls.push_back(w);
  for (const Wall& w : boxAt(3.6, -1.4, 0.4, 1.1)) walls.push_back(w);
  return walls;
}

/// Two parallel walls along x, without ends in sight.
inline std::vector<Wall> corridor() {
  return {{{-200, -1}, {200, -1}}, {{-200, 1.2}, {200, 1.2}}};
}

/// Ray casts a full turn of `beams` returns with Gaussian noise; beams that meet nothing within 20 m are
/// invalid.
inline Scan castScan(const std::vector<Wall>& walls, const Pose2& world_from_robot, double t,
                     std::mt19937& random, double sigma_m = 0.01, int beams = 360) {
  std::normal_distribution<double> noise(0, sigma_m);
  Scan scan;
  scan.t = t;
  scan.max_range_m = 20;
  scan.angle_min_rad = -M_PI;
  scan.angle_step_rad = 2 * M_PI / beams;
  const Eigen::Vector2d origin(world_from_robot.x, world_from_robot.y);
  for (int i = 0; i < beams; ++i) {
    const double angle = world_from_robot.yaw + scan.angle_min_rad + i * scan.angle_step_rad;
    const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
    double nearest = scan.max_range_m;
    for (const Wall& wall : walls) {
      const Eigen::Vector2d along = wall.to - wall.from, offset = wall.from - origin;
      const double cross = ray.x() * along.y() - ray.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const double range = (offset.x() * along.y() - offset.y() * along.x()) / cross;
      const double share = (offset.x() * ray.y() - offset.y() * ray.x()) / cross;
      if (range > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, range);
    }
    scan.valid.push_back(nearest < scan.max_range_m);
    scan.ranges_m.push_back(static_cast<float>(nearest + (scan.valid.back() ? noise(random) : 0)));
  }
  return scan;
}

}  // namespace roomgraph::test
