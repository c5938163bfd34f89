// SPDX-License-Identifier: BSD-3-Clause
// Planar poses over time with smooth interpolation, differentiable in time.
#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// (x, y, yaw) in m and rad; angles are not wrapped.
template <class T>
using PlanarValues = std::array<T, 3>;

/// Movement from a to b, in the frame of a; the angle as a difference.
template <class T>
PlanarValues<T> planarBetween(const PlanarValues<T>& a, const PlanarValues<T>& b) {
  using std::cos;
  using std::sin;
  const T c = cos(a[2]), s = sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
  return {c * dx + s * dy, c * dy - s * dx, b[2] - a[2]};
}

template <class T>
PlanarValues<T> planarProduct(const PlanarValues<T>& a, const PlanarValues<T>& b) {
  using std::cos;
  using std::sin;
  const T c = cos(a[2]), s = sin(a[2]);
  return {a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]};
}

inline double scalarOf(double value) {
  return value;
}
template <class T, int N>
double scalarOf(const ceres::Jet<T, N>& value) {
  return value.a;
}

/// One unbroken stretch of a source of planar poses, and a smooth curve through it: a uniform cubic B-spline
/// (Furgale, Barfoot and Sibley 2012). A curve that went through every pose would follow their noise,
/// differently so between poses than at them, which would draw time offsets to one of the two.
class PlanarPath {
 public:
  /// False when t is not after the last one. The angle is unwrapped.
  bool add(double t, const Pose2& pose);
  /// Fits the curve by least squares, when all poses are there. There must be two.
  void smooth();

  std::size_t size() const { return times_.size(); }
  double time(std::size_t i) const { return times_[i]; }
  const PlanarValues<double>& values(std::size_t i) const { return values_[i]; }
  /// Whether t lies within, at least `margin_s` from both ends.
  bool covers(double t, double margin_s) const {
    return size() >= 2 && t >= times_.front() + margin_s && t <= times_.back() - margin_s;
  }
  /// On the curve, which beyond its ends goes on as its last pieces do.
  template <class T>
  PlanarValues<T> at(const T& t) const {
    const std::size_t i = pieceOf(scalarOf(t));
    const T u = (t - times_.front()) / spacing_s_ - static_cast<double>(i);
    const std::array<T, 4> weights = basis(u);
    PlanarValues<T> out{T(0), T(0), T(0)};
    for (std::size_t n = 0; n < 4; ++n)
      for (std::size_t k = 0; k < 3; ++k) out[k] += weights[n] * controls_[i + n][k];
    return out;
  }

 private:
  template <class T>
  static std::array<T, 4> basis(const T& u) {
    const T v = 1.0 - u;
    return {v * v * v / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
            (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0, u * u * u / 6.0};
  }
  std::size_t pieceOf(double t) const {
    const double piece = std::floor((t - times_.front()) / spacing_s_);
    return static_cast<std::size_t>(std::clamp(piece, 0.0, static_cast<double>(controls_.size()) - 4));
  }

  std::vector<double> times_;
  std::vector<PlanarValues<double>> values_, controls_;
  double spacing_s_ = 0;
};

/// The stretch that covers t, or nothing.
inline const PlanarPath* pathAt(const std::vector<PlanarPath>& paths, double t, double margin_s) {
  for (const auto& path : paths)
    if (path.covers(t, margin_s)) return &path;
  return nullptr;
}

}  // namespace roomgraph
