// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes with materials, and the planar convex hull.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// What a surface looks like: a procedural pattern in one main colour.
struct Material {
  std::string pattern;                               ///< see texture.h
  std::array<double, 3> rgb{};                       ///< in [0, 1]
  double size_m = 1;                                 ///< edge of the square that the texture covers
  int variant = 0;                                   ///< another picture of the same pattern
  std::shared_ptr<const cv::Mat> picture = nullptr;  ///< of a mesh file: used instead of a pattern
  bool operator==(const Material&) const = default;
};

/// Materials by index; equal ones are stored once.
class MaterialList {
 public:
  int add(const Material& material);
  const std::vector<Material>& all() const { return materials_; }

 private:
  std::vector<Material> materials_;
};

struct MeshTriangle {
  std::array<Eigen::Vector3f, 3> position, normal;  ///< m, in the mesh's frame
  std::array<Eigen::Vector2f, 3> uv;                ///< in texture widths
  int material = 0;
};

struct Mesh {
  std::vector<MeshTriangle> triangles;

  Eigen::AlignedBox3d bounds() const;
  /// All triangles moved by `pose`.
  Mesh moved(const Pose3& pose) const;
  void append(const Mesh& other);
};

}  // namespace roomgraph
