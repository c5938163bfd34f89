// SPDX-License-Identifier: BSD-3-Clause
// Tessellation of the solids with normals and texture coordinates.
#include "mesh_builder.h"

#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr int kSides = 14;

/// Texture coordinates in metres: projected along the axis that the face looks at most, so patterns keep
/// their size.
Eigen::Vector2d planar(const Eigen::Vector3d& p, const Eigen::Vector3d& face) {
  const Eigen::Vector3d n = face.cwiseAbs();
  if (n.z() >= n.x() && n.z() >= n.y()) return {p.x(), p.y()};
  return n.x() >= n.y() ? Eigen::Vector2d(p.y(), -p.z()) : Eigen::Vector2d(p.x(), -p.z());
}

/// Rotation whose z axis is `axis`.
Eigen::Matrix3d alongZ(const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

}  // namespace

MeshBuilder& MeshBuilder::use(const Material& material) {
  material_ = materials_.add(material);
  texture_m_ = material.size_m;
  return *this;
}

MeshBuilder& MeshBuilder::frame(const Pose3& mesh_from_local) {
  frame_ = mesh_from_local;
  return *this;
}

void MeshBuilder::triangle(const Vertex& a, const Vertex& b, const Vertex& c) {
  const Eigen::Vector3d face = (b.position - a.position).cross(c.position - a.position);
  if (face.norm() < 1e-12) return;
  MeshTriangle out;
  out.material = material_;
  const Vertex* corners[3] = {&a, &b, &c};
  for (std::size_t i = 0; i < 3; ++i) {
    out.position[i] = (frame_ * corners[i]->position).cast<float>();
    out.normal[i] = (frame_.linear() * corners[i]->normal).cast<float>();
    out.uv[i] = (planar(corners[i]->position, face) / texture_m_).cast<float>();
  }
  mesh_.triangles.push_back(out);
}

void MeshBuilder::grid(const std::vector<std::vector<Vertex>>& rows, bool closed) {
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    const std::size_t columns = rows[r].size();
    for (std::size_t c = 0; c + (closed ? 0 : 1) < columns; ++c) {
      const std::size_t next = (c + 1) % columns;
      triangle(rows[r][c], rows[r][next], rows[r + 1][next]);
      triangle(rows[r][c], rows[r + 1][next], rows[r + 1][c]);
    }
  }
}

void MeshBuilder::quad(const std::array<Eigen::Vector3d, 4>& corners, bool once) {
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
  const std::size_t before = mesh_.triangles.size();
  triangle({corners[0], normal}, {corners[1], normal}, {corners[2], normal});
  triangle({corners[0], normal}, {corners[2], normal}, {corners[3], normal});
  if (!once || mesh_.triangles.size() != before + 2) return;
  // The first corner is the picture's lower left.
  mesh_.triangles[before].uv = {Eigen::Vector2f(0, 1), Eigen::Vector2f(1, 1), Eigen::Vector2f(1, 0)};
  mesh_.triangles[before + 1].uv = {Eigen::Vector2f(0, 1), Eigen::Vector2f(1, 0), Eigen::Vector2f(0, 0)};
}

void MeshBuilder::box(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Vector3d out = Eigen::Vector3d::Zero(), u = out, v = out;
      out[axis] = sign * size[axis] / 2;
      u[(axis + 1) % 3] = sign * size[(axis + 1) % 3] / 2;
      v[(axis + 2) % 3] = size[(axis + 2) % 3] / 2;
      const Eigen::Vector3d middle = center + out;
      quad({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
    }
  }
}

void MeshBuilder::superSphere(const Eigen::Vector3d& center, const Eigen::Vector3d& core,
                              const Eigen::Vector3d& radii) {
  constexpr int kSteps = 4;  // per quarter circle; each octant is moved to its corner of the core
  std::vector<std::vector<Vertex>> rows;
  for (int half = 0; half < 2; ++half) {
    for (int r = 0; r <= kSteps; ++r) {
      const double latitude = std::numbers::pi / 2 * (static_cast<double>(r) / kSteps - (half == 0 ? 1 : 0));
      std::vector<Vertex> row;
      for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const Eigen::Vector3d corner((quadrant == 0 || quadrant == 3 ? 1 : -1) * core.x(),
                                     (quadrant < 2 ? 1 : -1) * core.y(), (half == 0 ? -1 : 1) * core.z());
        for (int c = 0; c <= kSteps; ++c) {
          const double longitude = std::numbers::pi / 2 * (quadrant + static_cast<double>(c) / kSteps);
          const Eigen::Vector3d d(std::cos(latitude) * std::cos(longitude),
                                  std::cos(latitude) * std::sin(longitude), std::sin(latitude));
          row.push_back({center + corner + radii.cwiseProduct(d), d.cwiseQuotient(radii).normalized()});
        }
      }
      rows.push_back(std::move(row));
    }
  }
  // Bottom and top faces of the core.
  for (const double up : {-1.0, 1.0}) {
    const Eigen::Vector3d middle = center + Eigen::Vector3d(0, 0, up * (core.z() + radii.z()));
    const Eigen::Vector3d u(up * core.x(), 0, 0), v(0, core.y(), 0);
    quad({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
  }
  grid(rows, true);
}

void MeshBuilder::roundedBox(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double radius) {
  const double r = std::min(radius, size.minCoeff() / 2);
  superSphere(center, size / 2 - Eigen::Vector3d::Constant(r), Eigen::Vector3d::Constant(r));
}

void MeshBuilder::ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& radii) {
  superSphere(center, Eigen::Vector3d::Zero(), radii);
}

void MeshBuilder::rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from,
                      double radius_to) {
  const Pose3 outer = frame_;
  Pose3 local = Pose3::Identity();
  local.linear() = alongZ((to - from).normalized());
  local.translation() = from;
  frame_ = outer * local;
  const double length = (to - from).norm();
  lathe(Eigen::Vector3d::Zero(), {{0, 0}, {radius_from, 0}, {radius_to, length}, {0, length}});
  frame_ = outer;
}

void MeshBuilder::capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from,
                          double radius_to) {
  rod(from, to, radius_from, radius_to);
  ellipsoid(from, Eigen::Vector3d::Constant(radius_from));
  ellipsoid(to, Eigen::Vector3d::Constant(radius_to));
}

void MeshBuilder::lathe(const Eigen::Vector3d& base, const std::vector<Eigen::Vector2d>& profile) {
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Eigen::Vector2d along = profile[i + 1] - profile[i];
    const Eigen::Vector2d slope = Eigen::Vector2d(along.y(), -along.x()).normalized();
    std::vector<std::vector<Vertex>> rows(2);
    for (std::size_t r = 0; r < 2; ++r) {
      for (int c = 0; c < kSides; ++c) {
        const double angle = 2 * std::numbers::pi * c / kSides;
        const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0);
        rows[r].push_back({base + profile[i + r].x() * radial + Eigen::Vector3d(0, 0, profile[i + r].y()),
                           slope.x() * radial + Eigen::Vector3d(0, 0, slope.y())});
      }
    }
    grid(rows, true);
  }
}

}  // namespace roomgraph
