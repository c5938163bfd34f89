// SPDX-License-Identifier: BSD-3-Clause
// Material list, mesh transforms and Andrew's monotone chain.
#include "roomgraph/simulation/mesh.h"

#include <algorithm>

namespace roomgraph {

int MaterialList::add(const Material& material) {
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  if (found != materials_.end()) return static_cast<int>(found - materials_.begin());
  materials_.push_back(material);
  return static_cast<int>(materials_.size()) - 1;
}

Eigen::AlignedBox3d Mesh::bounds() const {
  Eigen::AlignedBox3d box;
  for (const auto& triangle : triangles)
    for (const auto& corner : triangle.position) box.extend(corner.cast<double>());
  return box;
}

Mesh Mesh::moved(const Pose3& pose) const {
  const Eigen::Isometry3f to = pose.cast<float>();
  Mesh out = *this;
  for (auto& triangle : out.triangles) {
    for (auto& corner : triangle.position) corner = to * corner;
    for (auto& normal : triangle.normal) normal = to.linear() * normal;
  }
  return out;
}

void Mesh::append(const Mesh& other) {
  triangles.insert(triangles.end(), other.triangles.begin(), other.triangles.end());
}

std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  // Monotone chain (Andrew 1979): lower hull from the left, upper hull from the right.
  std::vector<Eigen::Vector2d> hull;
  const auto turn = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  const auto sweep = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *it) <= 0) hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  sweep(points.begin(), points.end());
  sweep(points.rbegin(), points.rend());
  return hull;
}

}  // namespace roomgraph
