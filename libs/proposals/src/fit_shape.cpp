// SPDX-License-Identifier: BSD-3-Clause
// Levenberg-Marquardt shape fit with robust residuals, and front-back decision by the back rest.
#include "fit_shape.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "edge_agreement.h"
#include "plane_fit.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

constexpr int kPoints = 80;           // of the mask, used in the fit
constexpr double kPointsWeight = 16;  // all of them together count like so many independent points

constexpr double kMostTilt = 3;    // standard deviations the ground's normal is corrected by
constexpr double kPointScale = 4;  // standard deviations at which a point's pull levels off

constexpr int kFixed = 12;  // residuals: box sides, sizes, near side, yaw, leg, roll and pitch of the ground

// Large residuals level off (Geman-McClure): wrong mask points and box sides cut by an occluder.
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
  const Eigen::Vector3d size = sizeOf(p.shape), in_object(q.x(), q.y(), point.z());
  const Eigen::Vector3d offset = offsetOutside<double>(p.shape.kind, size, in_object);
  PointDistance out;
  out.value = std::sqrt(offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z());
  if (out.value <= 0) return out;
  const double a = offset.x() / out.value, b = offset.y() / out.value;
  out.gradient << sin_yaw * b - cos_yaw * a, -sin_yaw * a - cos_yaw * b, a * q.y() - b * q.x(),
      -std::abs(b) / 2, -std::abs(a) / 2, -std::max(0.0, offset.z()) / out.value;
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

  FitProblem(const PlacedShape& initial, const BoxEvidence& evidence) : initial_(initial), e_(evidence) {
    const auto& all = e_.mask.points;
    const double step = std::max(1.0, static_cast<double>(all.size()) / kPoints);
    std::vector<double> ranges;
    for (double i = 0; i < static_cast<double>(all.size()); i += step) {
      points_.push_back(all[static_cast<std::size_t>(i)].in_ground);
      ranges.push_back(points_.back().head<2>().norm());
    }
    near_range_ = quantile(ranges, 0.03);
    sigma_point_ = 0.03 + 2 * depthSigma(quantile(ranges, 0.5));
    point_weight_ = points_.empty() ? 0 : std::sqrt(kPointsWeight / static_cast<double>(points_.size()));
  }

  int inputs() const { return (round() ? 4 : 6) + (tilts() ? 2 : 0); }
  int values() const { return kFixed + static_cast<int>(points_.size()); }

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
    p.shape.width = std::max(0.05, x[round() ? 2 : 3]);
    p.shape.depth = std::max(0.05, x[round() ? 2 : 4]);
    p.shape.height = std::max(0.05, x[round() ? 3 : 5]);
    if (tilts()) {
      const double most = kMostTilt * e_.ground_tilt_sigma;
      p.roll = std::clamp(x[inputs() - 2], -most, most);
      p.pitch = std::clamp(x[inputs() - 1], -most, most);
    }
    return p;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    const PlacedShape p = shapeOf(x);
    residuals.head<kFixed>() = fixedResiduals(p);
    const double c = std::cos(p.yaw), s = std::sin(p.yaw);
    for (std::size_t i = 0; i < points_.size(); ++i)
      residuals[kFixed + static_cast<Eigen::Index>(i)] =
          point_weight_ * saturated(pointDistance(p, c, s, points_[i]).value / sigma_point_, kPointScale);
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
      jacobian.col(k).head<kFixed>() = (fixedResiduals(shapeOf(moved)) - here) / kStep;
    }
    const double c = std::cos(p.yaw), s = std::sin(p.yaw);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const PointDistance d = pointDistance(p, c, s, points_[i]);
      const double r = d.value / sigma_point_ / kPointScale;
      const Eigen::Matrix<double, 6, 1> row =
          point_weight_ / sigma_point_ * std::pow(1 + r * r, -1.5) * d.gradient;
      const auto index = kFixed + static_cast<Eigen::Index>(i);
      if (round()) {
        jacobian.row(index) << row[0], row[1], row[3] + row[4], row[5];
      } else {
        jacobian.row(index) = row.transpose();
      }
    }
    return 0;
  }

 private:
  using FixedResiduals = Eigen::Matrix<double, kFixed, 1>;

  bool round() const { return initial_.shape.kind == ShapeKind::kCylinder; }

  FixedResiduals fixedResiduals(const PlacedShape& p) const {
    FixedResiduals r;
    r.head<4>() = boxSides(p);
    const ObjectModel& m = *e_.model;
    r[4] = (p.shape.width - m.width_m) / std::max(m.width_sigma_m, 0.01);
    r[5] = (p.shape.depth - m.depth_m) / std::max(m.depth_sigma_m, 0.01);
    r[6] = (p.shape.height - m.height_m) / std::max(m.height_sigma_m, 0.01);
    r[7] = nearSideKnown() ? saturated((nearestRange(p) - near_range_) / (2 * sigma_point_), 3) : 0;
    // The directions of the sides, found in the points, say more about yaw than the box does.
    r[8] = round() ? 0 : wrapAngle(p.yaw - initial_.yaw) / (points_.empty() ? 0.4 : 0.08);
    r[9] = besideLeg(p);
    r[10] = tilts() ? p.roll / e_.ground_tilt_sigma : 0;
    r[11] = tilts() ? p.pitch / e_.ground_tilt_sigma : 0;
    return r;
  }

  // The local ground's normal is corrected when it was not seen: the box's sides, which the bottom and the
  // top circle or face reach, then disagree with the usual size (paper sec. IV.A).
  bool tilts() const { return points_.empty() && e_.ground_tilt_sigma > 0; }

  // How far the axis' foot is beside the leg, which was extended to the box's bottom line.
  double besideLeg(const PlacedShape& p) const {
    const Eigen::Vector3d foot = cameraFromObject(p, e_).translation();
    if (!p.leg_column || foot.z() <= 0) return 0;
    return saturated((e_.camera.project(foot).x() - *p.leg_column) / (3 + 0.04 * e_.box.width()), 3);
  }

  // What lies outside the image may be nearer than all that is seen.
  bool nearSideKnown() const {
    return !points_.empty() && (round() || !(e_.cut_left || e_.cut_right || e_.cut_bottom));
  }

  // Distance on the ground from below the camera to the model.
  static double nearestRange(const PlacedShape& p) {
    const Pose2 object_from_ground = Pose2{p.x, p.y, p.yaw}.inverse();
    return distanceOutside(p.shape, {object_from_ground.x, object_from_ground.y, 0}).x();
  }

  // A side at the image border says only that the model reaches the border there.
  Eigen::Vector4d boxSides(const PlacedShape& p) const {
    const auto projected = project(p, e_);
    if (!projected) return Eigen::Vector4d::Constant(20);
    const Box2 &seen = e_.box, &full = projected->full;
    const double su = 4 + 0.03 * seen.width(), sv = 4 + 0.03 * seen.height();
    const auto side = [](double outward, double sigma, bool cut) {
      return saturated((cut ? std::min(outward, 0.0) : outward) / sigma, 5);
    };
    return {side(seen.u_min - full.u_min, su, e_.cut_left), side(seen.v_min - full.v_min, sv, e_.cut_top),
            side(full.u_max - seen.u_max, su, e_.cut_right),
            side(full.v_max - seen.v_max, sv, e_.cut_bottom)};
  }

  PlacedShape initial_;
  const BoxEvidence& e_;
  std::vector<Eigen::Vector3d> points_;
  double near_range_ = 0, sigma_point_ = 0.03, point_weight_ = 0;
};

double meanOutside(const PlacedShape& placed, const std::vector<MaskPoint>& points) {
  if (points.empty()) return 0;
  const Pose3 object_from_ground = groundFromObject(placed).inverse();
  double sum = 0;
  for (const auto& p : points)
    sum += std::min(0.3, distanceOutside(placed.shape, object_from_ground * p.in_ground).norm());
  return sum / static_cast<double>(points.size());
}

}  // namespace

double backRestAgreement(const PlacedShape& placed, const std::vector<MaskPoint>& points) {
  const Pose3 object_from_ground = groundFromObject(placed).inverse();
  std::vector<Eigen::Vector3d> middle;
  std::vector<double> heights;
  for (const auto& p : points) {
    const Eigen::Vector3d q = object_from_ground * p.in_ground;
    if (std::abs(q.y()) > 0.3 * placed.shape.width) continue;  // arm rests may be as high as the back
    middle.push_back(q);
    heights.push_back(q.z());
  }
  const double high = 0.8 * quantile(heights, 0.97), low = 0.6 * high;
  double high_sum = 0, low_sum = 0;
  int high_count = 0, low_count = 0;
  for (const auto& q : middle) {
    if (q.z() >= high) high_sum += q.x(), ++high_count;
    if (q.z() <= low) low_sum += q.x(), ++low_count;
  }
  if (high_count < 5) return 0;
  const double back = high_sum / high_count, seat = low_count < 5 ? back : low_sum / low_count;
  return std::clamp((seat - 2 * back) / (placed.shape.depth / 2), -1.0, 1.0);
}

namespace {

// Which side is the front: as the back rest says; where no depth tells, furniture rather faces the viewer
// than the wall behind it.
double frontAgreement(const PlacedShape& placed, const BoxEvidence& evidence) {
  if (!evidence.mask.points.empty()) return backRestAgreement(placed, evidence.mask.points);
  return -0.3 * std::cos(placed.yaw - std::atan2(placed.y, placed.x));
}

}  // namespace

void judge(PlacedShape& placed, const BoxEvidence& evidence) {
  const ObjectModel& m = *evidence.model;
  placed.box_iou = boxIou(placed, evidence);
  const auto unusual = [](double value, double usual, double sigma) {
    return std::pow((value - usual) / std::max(sigma, 0.01), 2);
  };
  const double size = unusual(placed.shape.width, m.width_m, m.width_sigma_m) +
                      unusual(placed.shape.depth, m.depth_m, m.depth_sigma_m) +
                      unusual(placed.shape.height, m.height_m, m.height_sigma_m);
  placed.quality = placed.box_iou * std::exp(-meanOutside(placed, evidence.mask.points) / 0.15 - 0.08 * size);
  if (evidence.mask.points.empty())
    if (const auto edges = edgeAgreement(placed, evidence)) placed.quality *= 0.4 + 0.6 * *edges;
  if (m.symmetry == 1 && placed.shape.kind == ShapeKind::kCuboid)
    placed.quality *= 0.55 + 0.45 * frontAgreement(placed, evidence);
}

PlacedShape fitShape(const PlacedShape& initial, const BoxEvidence& evidence) {
  FitProblem problem(initial, evidence);
  Eigen::LevenbergMarquardt<FitProblem> solver(problem);
  solver.parameters.maxfev = 30;
  solver.parameters.xtol = solver.parameters.ftol = 1e-4;
  Eigen::VectorXd x = problem.vectorOf(initial);
  solver.minimize(x);
  PlacedShape fitted = x.allFinite() ? problem.shapeOf(x) : initial;
  judge(fitted, evidence);
  return fitted;
}

}  // namespace roomgraph
