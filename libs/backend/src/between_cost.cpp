// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of a movement's residual by both poses.
#include "between_cost.h"

#include "roomgraph/geometry/cross_matrix.h"

namespace roomgraph {
namespace {

using Eigen::Matrix3d, Eigen::Matrix4d, Eigen::Quaterniond, Eigen::Vector3d, Eigen::Vector4d;
using Matrix34d = Eigen::Matrix<double, 3, 4>;

// p q as a linear function of q, in the order (x, y, z, w).
Matrix4d timesRight(const Quaterniond& p) {
  Matrix4d out;
  out << p.w() * Matrix3d::Identity() + crossing(p.vec()), p.vec(), -p.vec().transpose(), p.w();
  return out;
}

// p q as a linear function of p.
Matrix4d timesLeft(const Quaterniond& q) {
  Matrix4d out;
  out << q.w() * Matrix3d::Identity() - crossing(q.vec()), q.vec(), -q.vec().transpose(), q.w();
  return out;
}

// v as q* sees it, v - 2 w (u x v) + 2 u x (u x v), by q = (u, w), whose length is taken for 1.
Matrix34d byRotation(const Quaterniond& q, const Vector3d& v) {
  const Vector3d u = q.vec();
  Matrix34d out;
  out << 2 * q.w() * crossing(v) + 2 * (u * v.transpose() + u.dot(v) * Matrix3d::Identity() - 2 * v * u.transpose()),
      -2 * u.cross(v);
  return out;
}

Matrix3d asSeenFrom(const Quaterniond& q) {
  const Matrix3d u = crossing(q.vec());
  return Matrix3d::Identity() - 2 * q.w() * u + 2 * u * u;
}

template <int Columns>
void write(double* to, const Eigen::Matrix<double, 6, Columns>& jacobian) {
  if (!to) return;
  Eigen::Map<Eigen::Matrix<double, 6, Columns, Eigen::RowMajor>> out(to);
  out = jacobian;
}

}  // namespace

bool BetweenCost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  residual_(blocks[0], blocks[1], blocks[2], blocks[3], residuals);
  if (!jacobians) return true;
  const Eigen::Map<const Vector3d> pa(blocks[0]), pb(blocks[2]);
  const Eigen::Map<const Quaterniond> qa(blocks[1]), qb(blocks[3]);
  const auto places = residual_.whitening.leftCols<3>(), turns = residual_.whitening.rightCols<3>();
  const Eigen::Matrix<double, 6, 3> moved = places * asSeenFrom(qa);
  write<3>(jacobians[0], -moved);
  write<3>(jacobians[2], moved);
  // Of 2 vec(m* (qa* qb)), the short way round.
  const Quaterniond measured = residual_.rotation.conjugate(), a_from_world = qa.conjugate();
  const double sign = (measured * (a_from_world * qb)).w() < 0 ? -2 : 2;
  const Matrix34d by_b = sign * (timesRight(measured) * timesRight(a_from_world)).topRows<3>();
  write<4>(jacobians[3], turns * by_b);
  const Vector4d conjugation(-1, -1, -1, 1);
  const Matrix34d by_a = sign * (timesRight(measured) * timesLeft(qb)).topRows<3>() * conjugation.asDiagonal();
  write<4>(jacobians[1], places * byRotation(qa, pb - pa) + turns * by_a);
  return true;
}

}  // namespace roomgraph
