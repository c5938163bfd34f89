// SPDX-License-Identifier: BSD-3-Clause
// Pinhole camera: projection, back-projection, intrinsic matrix, scaling.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace roomgraph {

/// Pinhole camera. Optical frame: x right, y down, z forward. Pixel centres have integer coordinates.
struct PinholeCamera {
  int width = 0, height = 0;              ///< px
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3 (OpenCV); images are undistorted on loading

  bool valid() const { return width > 0 && height > 0 && fx > 0 && fy > 0; }
  /// Pixel of a point with z > 0 (the caller's duty).
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  /// Direction K^-1 (u, v, 1), z = 1.
  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
  /// Point at depth z (metres along the optical axis) seen at a pixel.
  Eigen::Vector3d backProject(double u, double v, double z) const { return z * ray(u, v); }
  bool sees(double u, double v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  Eigen::Matrix3d matrix() const;
  /// The camera of the image resized by `factor`.
  PinholeCamera scaled(double factor) const;
  bool operator==(const PinholeCamera&) const = default;
};

}  // namespace roomgraph
