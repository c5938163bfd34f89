// SPDX-License-Identifier: BSD-3-Clause
// Error model of proposals along and across the view, with and without depth.
#include "proposal_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kHeightSigma = 0.02;   // m, of the ground below the object
constexpr double kBottomSigma_m = 0.05;  // of the lowest depth point of an object that does not rest on the ground

/// Standard deviations along and across the view, m, and of yaw, rad.
struct Deviations {
  double along = 0, across = 0, yaw = 0;
};

// Of a good fit to the points. A real sofa differs from a box, and its back is not seen.
Deviations withDepth(ShapeKind kind, double range) {
  const double z2 = range * range;
  if (kind == ShapeKind::kCylinder) return {0.025 + 0.003 * z2, 0.015 + 0.003 * range, 0};
  return {0.08 + 0.003 * z2, 0.05 + 0.005 * range, 0.06};
}

// From the box alone; paper Eq. 2 differentiated by the camera's pitch and by the row of the box's bottom.
Deviations withoutDepth(ShapeKind kind, double range, const BoxEvidence& e, double ground_tilt_sigma) {
  constexpr double kBottomSigma = 0.05;  // of the box's height; detectors' boxes, some of them partly hidden
  const double height = e.ground.offset;
  const double lever = (range * range + height * height) / std::max(height, 0.3);
  const double bottom = kBottomSigma * e.box.height() / e.camera.fy;
  const bool round = kind == ShapeKind::kCylinder;
  return {std::hypot(round ? 0.05 : 0.18, lever * std::hypot(ground_tilt_sigma, bottom)) + 0.01 * range,
          (round ? 0.02 : 0.10) + 0.01 * range, 0.5};
}

// Of a shape whose construction says how well each direction is known.
Eigen::Matrix4d constructed(const PlacedShape& placed) {
  const double misfit = std::pow(1 - std::clamp(placed.quality, 0.0, 1.0), 2);
  Eigen::Matrix4d out = Eigen::Matrix4d::Zero();
  out.topLeftCorner<2, 2>() =
      placed.covariance->topLeftCorner<2, 2>() + std::pow(0.2 * misfit, 2) * Eigen::Matrix2d::Identity();
  out(2, 2) = kHeightSigma * kHeightSigma;
  out(3, 3) = placed.has_yaw ? (*placed.covariance)(2, 2) : std::numbers::pi * std::numbers::pi;
  return out;
}

}  // namespace

Eigen::Matrix4d covarianceOf(const PlacedShape& placed, const BoxEvidence& e, double ground_tilt_sigma) {
  if (placed.covariance) return constructed(placed);
  constexpr double kFewPoints = 60;
  const double range = std::hypot(placed.x, placed.y);
  const bool supported = !e.mask.points.empty() && placed.supported;
  const ShapeKind kind = placed.shape.kind;
  Deviations s = supported ? withDepth(kind, range) : withoutDepth(kind, range, e, ground_tilt_sigma);
  const double misfit = std::pow(1 - std::clamp(placed.quality, 0.0, 1.0), 2);
  s.along += (kind == ShapeKind::kCylinder ? 2.0 : 0.4) * misfit;
  s.across += 0.2 * misfit;
  s.yaw += misfit;
  if (supported && static_cast<double>(e.mask.points.size()) < kFewPoints)
    s.along *= 1.5, s.across *= 1.3, s.yaw *= 2;
  if (e.cut.left || e.cut.right) s.across *= 1.7, s.along *= 1.2, s.yaw *= 1.5;
  if (e.cut.bottom) s.along *= 1.3;
  if (!placed.has_yaw) s.yaw = std::numbers::pi;
  const Eigen::Rotation2Dd turn(std::atan2(placed.y, placed.x));
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance.topLeftCorner<2, 2>() = turn.toRotationMatrix() *
                                     Eigen::Vector2d(s.along * s.along, s.across * s.across).asDiagonal() *
                                     turn.toRotationMatrix().transpose();
  const double height_sigma = e.model->rests_on_ground ? kHeightSigma : kBottomSigma_m;
  covariance(2, 2) = height_sigma * height_sigma;
  covariance(3, 3) = s.yaw * s.yaw;
  return covariance;
}

}  // namespace roomgraph
