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

}  // namespace roomgraph
