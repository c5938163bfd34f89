// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt fit of a shape with robust residuals.
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "plane_fit.h"
#include "roomgraph/core/order_statistics.h"
#include "roomgraph/geometry/shape_math.h"
#include "roomgraph/proposals/shape_fit.h"

namespace roomgraph {
namespace {

// Residuals besides those of the depth points, by their place in the vector.
enum Residual {
  kLeftSide, kTopSide, kRightSide, kBottomSide,  // of the projection against the box
  kWidth, kDepth, kHeight,                       // against the usual size
  kNearSide,                                     // nearest range against that of the points
  kYaw,                                          // against the direction of the start
  kLeg,                                          // foot of the axis against the leg's column
  kRoll, kPitch,                                 // of the ground, against the prediction
  kFixedCount
};

constexpr double kNearRange = 0.03;    // quantile of the ranges taken for the nearest point
constexpr double kLeastSize_m = 0.05;  // no side of the shape becomes smaller
constexpr int kMaxEvaluations = 30;    // bounds the time per hypothesis
constexpr double kTolerance = 1e-4;    // relative
constexpr double kSideErrors = 2;      // sigmas of a box side within which it may be at the image border
constexpr double kLargestLever = 0.5;  // of the place by the size: one side is fixed
constexpr double kLeastInformation = 1e-9;  // 1/m^2, 1/rad^2: what nothing in the image tells

// Geman-McClure residual: outliers are wrong mask points and box sides cut by an occluder.
double saturated(double r, double scale) {
  return r / std::sqrt(1 + r * r / (scale * scale));
}

// Distance of a point from the model's volume with its derivatives by (x, y, yaw) of the model, then width,
// depth and height (a cylinder: 0, diameter / 2 each for width and depth).
struct PointDistance {
  double value = 0;
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
};

PointDistance pointDistance(const PlacedShape& p, double cos_yaw, double sin_yaw,
                            const Eigen::Vector3d& point) {
  const double dx = point.x() - p.x, dy = point.y() - p.y;
  const Eigen::Vector2d q(cos_yaw * dx + sin_yaw * dy, cos_yaw * dy - sin_yaw * dx);
  const Eigen::Vector3d size = sizeOf(p.shape), in_object(q.x(), q.y(), point.z() - p.z);
  const Eigen::Vector3d offset = offsetOutside<double>(p.shape.kind, size, in_object);
  PointDistance out;
  out.value = std::sqrt(offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z());
  if (out.value <= 0) return out;
  const double a = offset.x() / out.value, b = offset.y() / out.value;
  out.gradient << sin_yaw * b - cos_yaw * a, -sin_yaw * a - cos_yaw * b, a * q.y() - b * q.x(), -std::abs(b) / 2,
      -std::abs(a) / 2, -std::max(0.0, offset.z()) / out.value;
  if (p.shape.kind == ShapeKind::kCylinder) {
    const double radial = distanceOutside<double>(p.shape.kind, size, in_object)[0];
    out.gradient.segment<2>(3).setConstant(-radial / out.value / 4);
  }
  return out;
}

// Residuals of the fit over (x, y, yaw, width, depth, height); a cylinder has (x, y, diameter, height).
class FitProblem {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  FitProblem(const PlacedShape& initial, const BoxEvidence& evidence, const FitWeights& weights)
      : initial_(initial), e_(evidence), w_(weights) {
    const auto& all = e_.mask.points;
    const double step = std::max(1.0, static_cast<double>(all.size()) / w_.max_points);
    std::vector<double> ranges;
    for (double i = 0; i < static_cast<double>(all.size()); i += step) {
      points_.push_back(all[static_cast<std::size_t>(i)].in_ground);
      ranges.push_back(points_.back().head<2>().norm());
    }
    near_range_ = quantile(ranges, kNearRange);
    sigma_point_ = w_.point_sigma_m + w_.point_noise_gain * depthSigma(quantile(ranges, 0.5));
    point_weight_ = points_.empty() ? 0 : std::sqrt(w_.all_points / static_cast<double>(points_.size()));
  }

  int inputs() const { return (round() ? 4 : 6) + (tilts() ? 2 : 0); }
  int values() const { return kFixedCount + static_cast<int>(points_.size()); }

  Eigen::VectorXd vectorOf(const PlacedShape& p) const {
    Eigen::VectorXd x(inputs());
    if (round()) {
      x.head<4>() << p.x, p.y, 2 * p.shape.radius(), p.shape.height;
    } else {
      x.head<6>() << p.x, p.y, p.yaw, p.shape.width, p.shape.depth, p.shape.height;
    }
    if (tilts()) x.tail<2>() << p.roll, p.pitch;
    return x;
  }

  PlacedShape shapeOf(const Eigen::VectorXd& x) const {
    PlacedShape p = initial_;
    p.x = x[0];
    p.y = x[1];
    if (!round()) p.yaw = wrapAngle(x[2]);
    p.shape.width = std::max(kLeastSize_m, x[round() ? 2 : 3]);
    p.shape.depth = std::max(kLeastSize_m, x[round() ? 2 : 4]);
    p.shape.height = std::max(kLeastSize_m, x[round() ? 3 : 5]);
    if (tilts()) {
      const double most = w_.max_tilt * e_.ground_tilt_sigma;
      p.roll = std::clamp(x[inputs() - 2], -most, most);
      p.pitch = std::clamp(x[inputs() - 1], -most, most);
    }
    return p;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    const PlacedShape p = shapeOf(x);
    residuals.head<kFixedCount>() = fixedResiduals(p);
    const double c = std::cos(p.yaw), s = std::sin(p.yaw);
    for (std::size_t i = 0; i < points_.size(); ++i)
      residuals[kFixedCount + static_cast<Eigen::Index>(i)] =
          point_weight_ * saturated(pointDistance(p, c, s, points_[i]).value / sigma_point_, w_.point_saturation);
    return 0;
  }

  // The points' part in closed form, the rest by finite differences.
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep = 1e-6;
    const PlacedShape p = shapeOf(x);
    const FixedResiduals here = fixedResiduals(p);
    for (int k = 0; k < inputs(); ++k) {
      Eigen::VectorXd moved = x;
      moved[k] += kStep;
      jacobian.col(k).head<kFixedCount>() = (fixedResiduals(shapeOf(moved)) - here) / kStep;
    }
    const double c = std::cos(p.yaw), s = std::sin(p.yaw);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const PointDistance d = pointDistance(p, c, s, points_[i]);
      const double r = d.value / sigma_point_ / w_.point_saturation;
      const Eigen::Matrix<double, 6, 1> row =
          point_weight_ / sigma_point_ * std::pow(1 + r * r, -1.5) * d.gradient;
      const auto index = kFixedCount + static_cast<Eigen::Index>(i);
      if (round()) {
        jacobian.row(index) << row[0], row[1], row[3] + row[4], row[5];
      } else {
        jacobian.row(index) = row.transpose();
      }
    }
    return 0;
  }

  // What the image said about the size beyond the usual one, and how the place depends on it, at the
  // solution.
  void describe(const Eigen::VectorXd& x, PlacedShape& fitted) const {
    Eigen::MatrixXd jacobian(values(), inputs());
    df(x, jacobian);
    const Eigen::MatrixXd covariance =
        (jacobian.transpose() * jacobian + kLeastInformation * Eigen::MatrixXd::Identity(inputs(), inputs()))
            .inverse();
    const Eigen::Index first = round() ? 2 : 3, sizes = round() ? 2 : 3;
    const Eigen::MatrixXd by_size = Eigen::Rotation2Dd(-fitted.yaw).toRotationMatrix() *
                                    covariance.block(0, first, 2, sizes) *
                                    covariance.block(first, first, sizes, sizes).inverse();
    const Eigen::Vector3d usual = e_.model->sizeSigma().cwiseAbs2().cwiseInverse();
    const Eigen::VectorXd known = covariance.diagonal().cwiseInverse();
    if (round()) {
      // Width and depth say the same about one diameter.
      const double share = std::max(0.0, known[2] / (usual[0] + usual[1]) - 1);
      fitted.size_information = {share * usual[0], share * usual[1], std::max(0.0, known[3] - usual[2])};
      fitted.place_by_size << by_size.col(0) / 2, by_size.col(0) / 2, by_size.col(1);
    } else {
      fitted.size_information = (known.segment<3>(3) - usual).cwiseMax(0);
      for (const auto& [axis, size] : {std::pair(1, 0), std::pair(0, 1)})
        if (endsBeyondACut(fitted, axis)) onlyAtLeast(fitted, size);
      fitted.place_by_size = by_size;
    }
    fitted.place_by_size = fitted.place_by_size.cwiseMax(-kLargestLever).cwiseMin(kLargestLever);
  }

 private:
  using FixedResiduals = Eigen::Matrix<double, kFixedCount, 1>;

  bool round() const { return initial_.shape.kind == ShapeKind::kCylinder; }

  FixedResiduals fixedResiduals(const PlacedShape& p) const {
    FixedResiduals r;
    r.head<4>() = boxSides(p);
    const ObjectModel& m = *e_.model;
    r.segment<3>(kWidth) = (sizeOf(p.shape) - sizeOf(m.nominal())).cwiseQuotient(m.sizeSigma());
    r[kNearSide] = nearSideKnown() && p.behind_its_points
                       ? saturated((nearestRange(p) - near_range_) / (w_.near_side_gain * sigma_point_),
                                   w_.near_side_saturation)
                       : 0;
    // The directions of the sides, found in the depth points, are more accurate than what the box tells of yaw.
    const double yaw_sigma = points_.empty() ? w_.yaw_sigma_blind_rad : w_.yaw_sigma_rad;
    r[kYaw] = round() ? 0 : wrapAngle(p.yaw - initial_.yaw) / yaw_sigma;
    r[kLeg] = besideLeg(p);
    r[kRoll] = tilts() ? p.roll / e_.ground_tilt_sigma : 0;
    r[kPitch] = tilts() ? p.pitch / e_.ground_tilt_sigma : 0;
    return r;
  }

  // The local ground's normal is corrected when it was predicted, not measured: an error makes the projection of the
  // usual size disagree with the box's sides (paper sec. IV.A).
  bool tilts() const { return points_.empty() && e_.ground_tilt_sigma > 0; }

  // Horizontal distance in the image of the axis' foot from the leg, extended to the box's bottom side.
  double besideLeg(const PlacedShape& p) const {
    const Eigen::Vector3d foot = cameraFromObject(p, e_).translation();
    if (!p.leg_column || foot.z() <= 0) return 0;
    return saturated((e_.camera.project(foot).x() - *p.leg_column) / (w_.leg_px + w_.leg_share * e_.box.width()),
                     w_.leg_saturation);
  }

  // Parts outside the image may be nearer than every depth point.
  bool nearSideKnown() const {
    return !points_.empty() && (round() || !(e_.cut.left || e_.cut.right || e_.cut.bottom));
  }

  // Distance on the ground from below the camera to the model.
  static double nearestRange(const PlacedShape& p) {
    const Pose2 object_from_ground = Pose2{p.x, p.y, p.yaw}.inverse();
    return distanceOutside(p.shape, {object_from_ground.x, object_from_ground.y, 0}).x();
  }

  // Whether an end of the model's axis (0: depth, 1: width) is where the object may go on: beyond a cut side of the box, or
  // at the image border as far as a detector's box tells.
  bool endsBeyondACut(const PlacedShape& p, int axis) const {
    const double slack = kSideErrors * (w_.box_side_px + w_.box_side_share * e_.box.width());
    const double first = (e_.cut.left ? std::max(0.0, e_.box.u_min) : 0) + slack,
                 last = (e_.cut.right ? std::min<double>(e_.box.u_max, e_.camera.width) : e_.camera.width) - slack;
    const Pose3 camera_from_object = cameraFromObject(p, e_);
    const Eigen::Vector2d half(p.shape.depth / 2, p.shape.width / 2);
    for (const double end : {-1.0, 1.0})
      for (const double side : {-1.0, 1.0}) {
        Eigen::Vector3d corner(0, 0, p.shape.height / 2);
        corner[axis] = end * half[axis];
        corner[1 - axis] = side * half[1 - axis];
        const Eigen::Vector3d at = camera_from_object * corner;
        if (at.z() <= 0) return true;
        const double u = e_.camera.project(at).x();
        if (u < first || u > last) return true;
      }
    return false;
  }

  // Points up to a cut side say how long it is at least: more than usual, or nothing.
  void onlyAtLeast(PlacedShape& fitted, int size) const {
    double& information = fitted.size_information[size];
    const bool longer = sizeOf(fitted.shape)[size] > sizeOf(e_.model->nominal())[size];
    fitted.least_size_information[size] = longer ? information : 0;
    information = 0;
  }

  // At a cut side the model must reach the side; how far beyond is unknown. The other sides bound what of it is between
  // the cut ones.
  Eigen::Vector4d boxSides(const PlacedShape& p) const {
    const auto projected = project(p, e_);
    if (!projected) return Eigen::Vector4d::Constant(w_.out_of_view);
    const Box2 &seen = e_.box, &full = projected->full;
    const Box2 between =
        boundsWithin(windowBetween(seen, e_.cut), p.shape, cameraFromObject(p, e_), e_.camera).value_or(full);
    const double su = w_.box_side_px + w_.box_side_share * seen.width(),
                 sv = w_.box_side_px + w_.box_side_share * seen.height();
    const auto side = [&](double beyond, double outward, double sigma, bool cut) {
      return saturated((cut ? std::min(beyond, 0.0) : outward) / sigma, w_.box_side_saturation);
    };
    return {side(seen.u_min - full.u_min, seen.u_min - between.u_min, su, e_.cut.left),
            side(seen.v_min - full.v_min, seen.v_min - between.v_min, sv, e_.cut.top),
            side(full.u_max - seen.u_max, between.u_max - seen.u_max, su, e_.cut.right),
            side(full.v_max - seen.v_max, between.v_max - seen.v_max, sv, e_.cut.bottom)};
  }

  PlacedShape initial_;
  const BoxEvidence& e_;
  const FitWeights& w_;
  std::vector<Eigen::Vector3d> points_;
  double near_range_ = 0, sigma_point_ = 0.03, point_weight_ = 0;
};

}  // namespace

PlacedShape fitShape(const PlacedShape& initial, const BoxEvidence& evidence, const FitWeights& weights) {
  FitProblem problem(initial, evidence, weights);
  Eigen::LevenbergMarquardt<FitProblem> solver(problem);
  solver.parameters.maxfev = kMaxEvaluations;
  solver.parameters.xtol = solver.parameters.ftol = kTolerance;
  Eigen::VectorXd x = problem.vectorOf(initial);
  solver.minimize(x);
  PlacedShape fitted = x.allFinite() ? problem.shapeOf(x) : initial;
  if (x.allFinite()) problem.describe(x, fitted);
  judge(fitted, evidence);
  return fitted;
}

}  // namespace roomgraph
