// SPDX-License-Identifier: BSD-3-Clause
// Nearest-neighbour distance in a planar point set.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace roomgraph {

/// Exact distance to the nearest of a set of points in the plane.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Eigen::Vector2d> points);
  ~NearestPoint();
  NearestPoint(const NearestPoint&) = delete;
  NearestPoint& operator=(const NearestPoint&) = delete;

  /// Infinite when there are no points.
  double distance(const Eigen::Vector2d& from) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace roomgraph
