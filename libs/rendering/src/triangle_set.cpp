// SPDX-License-Identifier: BSD-3-Clause
// Triangulation of polygons, ribbons, outlines and discs.
#include "roomgraph/rendering/triangle_set.h"

#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

mrpt::math::TPoint3Df toMrpt(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

void TriangleSet::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                           const palette::TColor& color) {
  mrpt::opengl::TTriangle triangle(toMrpt(a), toMrpt(b), toMrpt(c));
  triangle.setColor(color);
  triangles_->insertTriangle(triangle);
}

void TriangleSet::polygon(const std::vector<Eigen::Vector3d>& corners, const palette::TColor& color) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i], color);
}

void TriangleSet::ribbon(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double width,
                         const palette::TColor& color) {
  Eigen::Vector3d side(from.y() - to.y(), to.x() - from.x(), 0);
  if (side.norm() < 1e-9) return;
  side *= width / 2 / side.norm();
  polygon({from - side, to - side, to + side, from + side}, color);
}

void TriangleSet::outline(const std::vector<Eigen::Vector3d>& corners, double width,
                          const palette::TColor& color) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    ribbon(corners[i], corners[(i + 1) % corners.size()], width, color);
    disc(corners[i], width / 2, color, 8);
  }
}

void TriangleSet::disc(const Eigen::Vector3d& center, double radius, const palette::TColor& color,
                       int sides) {
  std::vector<Eigen::Vector3d> rim;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    rim.push_back(center + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
  }
  polygon(rim, color);
}

mrpt::opengl::CSetOfTriangles::Ptr TriangleSet::object(const std::string& name) const {
  triangles_->enableLight(false);
  triangles_->setName(name);
  return triangles_;
}

}  // namespace roomgraph
