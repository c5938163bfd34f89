// SPDX-License-Identifier: BSD-3-Clause
// Residuals of relative poses, ground plane and landmark position, for automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "roomgraph/backend/factors.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {

// Pure residual functions, templated for automatic differentiation. Poses are (translation, quaternion x y z
// w).

/// Square root of an information matrix: L with Lᵀ L = covariance⁻¹.
template <int N>
Eigen::Matrix<double, N, N> sqrtInformation(const Eigen::Matrix<double, N, N>& covariance) {
  const Eigen::Matrix<double, N, N> information = covariance.inverse();
  return Eigen::LLT<Eigen::Matrix<double, N, N>>(information).matrixU();
}

/// Difference of two angles, wrapped; differentiable.
template <class T>
T angleDifference(const T& a, const T& b) {
  using std::atan2, std::cos, std::sin;
  return atan2(sin(a - b), cos(a - b));
}

struct BetweenResidual {
  explicit BetweenResidual(const BetweenFactor& f)
      : translation(f.a_from_b.translation()),
        rotation(f.a_from_b.linear()),
        whitening(sqrtInformation<6>(f.covariance)) {}

  template <class T>
  bool operator()(const T* ta, const T* qa, const T* tb, const T* qb, T* out) const {
    const Eigen::Map<const Vec3<T>> pa(ta), pb(tb);
    const Eigen::Map<const Eigen::Quaternion<T>> ra(qa), rb(qb);
    const Eigen::Quaternion<T> a_from_world = ra.conjugate();
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = a_from_world * (pb - pa) - translation.cast<T>();
    Eigen::Quaternion<T> delta = rotation.conjugate().cast<T>() * (a_from_world * rb);
    if (delta.w() < T(0)) delta.coeffs() = -delta.coeffs();  // the short way round
    error.template tail<3>() = T(2) * delta.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> whitened(out);
    whitened = whitening.cast<T>() * error;
    return true;
  }

  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
  Matrix6d whitening;
};

struct PlanarResidual {
  explicit PlanarResidual(const PlanarFactor& f) : factor(f) {}

  template <class T>
  bool operator()(const T* t, const T* q, T* out) const {
    const Eigen::Map<const Eigen::Quaternion<T>> rotation(q);
    const Vec3<T> up = rotation * factor.up_in_robot.cast<T>();
    out[0] = (t[2] + (rotation * factor.place_in_robot.cast<T>()).z()) / T(factor.sigma_z_m);
    out[1] = up.x() / T(factor.sigma_tilt_rad);
    out[2] = up.y() / T(factor.sigma_tilt_rad);
    return true;
  }

  PlanarFactor factor;
};

struct GroundResidual {
  explicit GroundResidual(const GroundFactor& f)
      : normal(f.normal_in_robot.normalized()),
        offset(f.offset_m),
        sigma_normal(f.sigma_normal_rad),
        sigma_offset(f.sigma_offset_m),
        place(f.place_in_robot) {}

  template <class T>
  bool operator()(const T* t, const T* q, T* out) const {
    const Eigen::Map<const Eigen::Quaternion<T>> rotation(q);
    const Vec3<T> up = rotation * normal.cast<T>();
    out[0] = up.x() / T(sigma_normal);
    out[1] = up.y() / T(sigma_normal);
    out[2] = (t[2] + (rotation * place.cast<T>()).z() - T(offset)) / T(sigma_offset);
    return true;
  }

  Eigen::Vector3d normal;
  double offset, sigma_normal, sigma_offset;
  Eigen::Vector3d place;
};

/// Square root of the information of (x, y, z, yaw). Without a measured yaw its row and column are zero.
inline Eigen::Matrix4d placeWhitening(Eigen::Matrix4d covariance, bool has_yaw) {
  if (has_yaw) return sqrtInformation<4>(covariance);
  covariance.row(3).setZero();
  covariance.col(3).setZero();
  covariance(3, 3) = 1;
  Eigen::Matrix4d whitening = sqrtInformation<4>(covariance);
  whitening.row(3).setZero();
  return whitening;
}

struct LandmarkResidual {
  explicit LandmarkResidual(const LandmarkFactor& f)
      : factor(f), whitening(placeWhitening(f.covariance, f.has_yaw)) {}

  template <class T>
  bool operator()(const T* t, const T* q, const T* landmark, T* out) const {
    const Eigen::Map<const Vec3<T>> position(t), object(landmark);
    const Eigen::Map<const Eigen::Quaternion<T>> rotation(q);
    const Vec3<T> seen = rotation.conjugate() * (object - position);
    const Vec3<T> ahead = rotation * factor.ahead_in_robot.cast<T>();
    using std::atan2;
    Eigen::Matrix<T, 4, 1> error;
    error.template head<3>() = seen - factor.position_in_robot.cast<T>();
    error[3] = angleDifference(T(landmark[3] - atan2(ahead.y(), ahead.x())), T(factor.yaw_in_robot));
    Eigen::Map<Eigen::Matrix<T, 4, 1>> whitened(out);
    whitened = whitening.cast<T>() * error;
    return true;
  }

  LandmarkFactor factor;
  Eigen::Matrix4d whitening;
};

struct LandmarkViewResidual {
  explicit LandmarkViewResidual(const LandmarkViewFactor& f)
      : factor(f), whitening(placeWhitening(f.covariance, f.has_yaw)) {}

  template <class T>
  bool operator()(const T* view, const T* landmark, const T* size, T* out) const {
    const Eigen::Matrix<T, 2, 1> offset =
        factor.offset_m.cast<T>() + factor.offset_by_size.cast<T>() * Eigen::Map<const Vec3<T>>(size);
    using std::cos, std::sin;
    const T c = cos(landmark[3]), s = sin(landmark[3]);
    Eigen::Matrix<T, 4, 1> error;
    for (int i = 0; i < 3; ++i) error[i] = view[i] - landmark[i];
    error[0] -= c * offset[0] - s * offset[1];
    error[1] -= s * offset[0] + c * offset[1];
    error[3] = angleDifference(view[3], landmark[3]);
    Eigen::Map<Eigen::Matrix<T, 4, 1>> whitened(out);
    whitened = whitening.cast<T>() * error;
    return true;
  }

  LandmarkViewFactor factor;
  Eigen::Matrix4d whitening;
};

struct LandmarkGroundResidual {
  explicit LandmarkGroundResidual(const LandmarkGroundFactor& f) : sigma(f.sigma_z_m) {}

  template <class T>
  bool operator()(const T* landmark, T* out) const {
    out[0] = landmark[2] / T(sigma);
    return true;
  }

  double sigma;
};

}  // namespace roomgraph
