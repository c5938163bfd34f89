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

// The values below were calibrated so that the errors of the best proposal are consistent with them:
// `roomgraph bench proposals` prints the normalised squared errors. What is not known of a cuboid's size stands apart
// (placeSpread()); where both its ends are seen it hardly matters.

// Error of a good fit to depth points: along the view a constant (m) and a part with the squared range (1/m), as of
// stereo depth; across it a constant and a part with the range; yaw (rad). A real sofa differs from a box, and its back
// is not seen.
struct FitError {
  double along_m, along_per_m, across_m, across_ratio, yaw_rad;
};
constexpr FitError kRoundFit{0.025, 0.003, 0.015, 0.003, 0}, kSidedFit{0.08, 0.003, 0.05, 0.005, 0.06};

// Error of a shape placed by its box alone: constants (m), to which parts with the range and the box's bottom add.
struct BoxError {
  double along_m, across_m;
};
constexpr BoxError kRoundBox{0.05, 0.02}, kSidedBox{0.18, 0.10};
constexpr double kBoxPerRange = 0.01, kBoxYaw_rad = 0.5;
constexpr double kBottomSigma = 0.05;   // of the box's height; detectors' boxes, some of them partly hidden
constexpr double kLeastCamera_m = 0.3;  // camera height below which Eq. 2 tells no range

// What a quality of 0 adds (m, rad); less by the square of 1 - quality. A poorly fitted cylinder has the largest error
// along the view, as it has no corner or side that fixes it.
constexpr double kMisfitRound_m = 2.0, kMisfitSided_m = 0.4, kMisfitAcross_m = 0.2, kMisfitYaw_rad = 1;
constexpr double kFewPoints = 60;  // with fewer the error is larger than the model above

/// Factors on the standard deviations.
struct Growth {
  double along, across, yaw;
};
constexpr Growth kWithFewPoints{1.5, 1.3, 2}, kWithCutSide{1.2, 1.7, 1.5}, kWithCutBottom{1.3, 1, 1};

/// Standard deviations along and across the view, m, and of yaw, rad.
struct Deviations {
  double along = 0, across = 0, yaw = 0;

  void grow(const Growth& by) {
    along *= by.along;
    across *= by.across;
    yaw *= by.yaw;
  }
};

Deviations withDepth(ShapeKind kind, double range) {
  const double z2 = range * range;
  const FitError& fit = kind == ShapeKind::kCylinder ? kRoundFit : kSidedFit;
  return {fit.along_m + fit.along_per_m * z2, fit.across_m + fit.across_ratio * range, fit.yaw_rad};
}

// From the box alone; paper Eq. 2 differentiated by the camera's pitch and by the row of the box's bottom.
Deviations withoutDepth(ShapeKind kind, double range, const BoxEvidence& e, double ground_tilt_sigma) {
  const double height = e.ground.offset;
  const double lever = (range * range + height * height) / std::max(height, kLeastCamera_m);
  const double bottom = kBottomSigma * e.box.height() / e.camera.fy;
  const BoxError& error = kind == ShapeKind::kCylinder ? kRoundBox : kSidedBox;
  return {std::hypot(error.along_m, lever * std::hypot(ground_tilt_sigma, bottom)) + kBoxPerRange * range,
          error.across_m + kBoxPerRange * range, kBoxYaw_rad};
}

// Covariance of a shape whose construction comes with one.
Eigen::Matrix4d constructed(const PlacedShape& placed) {
  const double misfit = std::pow(1 - std::clamp(placed.quality, 0.0, 1.0), 2);
  Eigen::Matrix4d out = Eigen::Matrix4d::Zero();
  out.topLeftCorner<2, 2>() =
      placed.covariance->topLeftCorner<2, 2>() + std::pow(kMisfitAcross_m * misfit, 2) * Eigen::Matrix2d::Identity();
  out(2, 2) = kHeightSigma * kHeightSigma;
  out(3, 3) = placed.has_yaw ? (*placed.covariance)(2, 2) : std::numbers::pi * std::numbers::pi;
  return out;
}

}  // namespace

Eigen::Matrix4d covarianceOf(const PlacedShape& placed, const BoxEvidence& e, double ground_tilt_sigma) {
  if (placed.covariance) return constructed(placed);
  const double range = std::hypot(placed.x, placed.y);
  const bool supported = !e.mask.points.empty() && placed.supported;
  const ShapeKind kind = placed.shape.kind;
  Deviations s = supported ? withDepth(kind, range) : withoutDepth(kind, range, e, ground_tilt_sigma);
  const double misfit = std::pow(1 - std::clamp(placed.quality, 0.0, 1.0), 2);
  s.along += (kind == ShapeKind::kCylinder ? kMisfitRound_m : kMisfitSided_m) * misfit;
  s.across += kMisfitAcross_m * misfit;
  s.yaw += kMisfitYaw_rad * misfit;
  if (supported && static_cast<double>(e.mask.points.size()) < kFewPoints) s.grow(kWithFewPoints);
  if (e.cut.left || e.cut.right) s.grow(kWithCutSide);
  if (e.cut.bottom) s.grow(kWithCutBottom);
  s.along = std::hypot(s.along, placed.open_along_m);
  if (!placed.has_yaw) s.yaw = std::numbers::pi;
  const Eigen::Rotation2Dd turn(std::atan2(placed.y, placed.x));
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance.topLeftCorner<2, 2>() = turn.toRotationMatrix() *
                                     Eigen::Vector2d(s.along * s.along, s.across * s.across).asDiagonal() *
                                     turn.toRotationMatrix().transpose();
  // How far it reaches from the side that was seen is the class's usual size.
  if (kind == ShapeKind::kCuboid)
    covariance.topLeftCorner<2, 2>() +=
        placeSpread(placed.place_by_size, placed.yaw, placed.size_information, e.model->sizeSigma());
  const double height_sigma = e.model->rests_on_ground ? kHeightSigma : kBottomSigma_m;
  covariance(2, 2) = height_sigma * height_sigma;
  covariance(3, 3) = s.yaw * s.yaw;
  return covariance;
}

}  // namespace roomgraph
