// SPDX-License-Identifier: BSD-3-Clause
// Axis-aligned rectangle in an image, with intersection, clipping and IoU.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace roomgraph {

/// Axis-aligned image rectangle in pixels, [u_min, u_max) x [v_min, v_max), u to the right, v down.
struct Box2 {
  double u_min = 0, v_min = 0, u_max = 0, v_max = 0;

  double width() const { return u_max - u_min; }
  double height() const { return v_max - v_min; }
  /// 0 for an empty or inverted box.
  double area() const { return width() > 0 && height() > 0 ? width() * height() : 0; }
  bool empty() const { return !(width() > 0 && height() > 0); }
  double diagonal() const { return std::hypot(width(), height()); }
  Eigen::Vector2d center() const { return {(u_min + u_max) / 2, (v_min + v_max) / 2}; }
  bool contains(double u, double v) const { return u >= u_min && u < u_max && v >= v_min && v < v_max; }
  bool operator==(const Box2&) const = default;
};

/// The common part; empty when there is none.
Box2 intersection(const Box2& a, const Box2& b);
/// The part inside an image of the given size.
Box2 clipped(const Box2& box, int width, int height);
/// Intersection over union in [0, 1]; 0 when both are empty.
double iou(const Box2& a, const Box2& b);

}  // namespace roomgraph
