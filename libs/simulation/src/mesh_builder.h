// SPDX-License-Identifier: BSD-3-Clause
// Builder of meshes from boxes, rods, ellipsoids and bodies of revolution.
#pragma once

#include "roomgraph/simulation/mesh.h"

namespace roomgraph {

/// Makes meshes from simple solids; surfaces are closed and their normals point outwards. Lengths in metres.
class MeshBuilder {
 public:
  explicit MeshBuilder(MaterialList& materials) : materials_(materials) {}

  /// Everything that follows looks like this.
  MeshBuilder& use(const Material& material);
  /// Everything that follows is placed in this frame.
  MeshBuilder& frame(const Pose3& mesh_from_local);

  /// Corners counter-clockwise as seen from the front; the texture is stretched over it once when `once`.
  void quad(const std::array<Eigen::Vector3d, 4>& corners, bool once = false);
  void box(const Eigen::Vector3d& center, const Eigen::Vector3d& size);
  /// Box whose edges are rounded: cushions, panels. radius <= half of the smallest edge.
  void roundedBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double radius);
  void ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& radii);
  /// Round rod with flat ends, tapered when the radii differ.
  void rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from, double radius_to);
  /// Rod with half spheres at its ends: limbs.
  void capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from, double radius_to);
  /// Body of revolution about the z axis through `base`; (radius, height) from bottom to top.
  void lathe(const Eigen::Vector3d& base, const std::vector<Eigen::Vector2d>& profile);

  Mesh take() { return std::move(mesh_); }

 private:
  struct Vertex {
    Eigen::Vector3d position, normal;
  };
  void triangle(const Vertex& a, const Vertex& b, const Vertex& c);
  /// rows x columns of vertices; the columns close when `closed`.
  void grid(const std::vector<std::vector<Vertex>>& rows, bool closed);
  void superSphere(const Eigen::Vector3d& center, const Eigen::Vector3d& core, const Eigen::Vector3d& radii);

  MaterialList& materials_;
  Mesh mesh_;
  int material_ = 0;
  double texture_m_ = 1;
  Pose3 frame_ = Pose3::Identity();
};

}  // namespace roomgraph
