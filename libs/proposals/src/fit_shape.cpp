// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/proposals/fit_shape.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "roomgraph/proposals/plane_fit.h"

namespace roomgraph {
namespace {

constexpr int kPoints = 80;           // of the mask, used in the fit
constexpr double kPointsWeight = 16;  // all of them together count like so many independent points

constexpr int kFixed = 9;  // residuals: box sides, sizes, near side, yaw

// Large residuals level off (Geman-McClure): wrong mask points and box sides cut by an occluder.
double saturated(double r, double scale) {
  return r / std::sqrt(1 + r * r / (scale * scale));
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
  }

  int inputs() const { return round() ? 4 : 6; }
  int values() const { return kFixed + static_cast<int>(points_.size()); }

  Eigen::VectorXd vectorOf(const PlacedShape& p) const {
    Eigen::VectorXd x(inputs());
    if (round()) {
      x << p.x, p.y, 2 * p.shape.radius(), p.shape.height;
    } else {
      x << p.x, p.y, p.yaw, p.shape.width, p.shape.depth, p.shape.height;
    }
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
    return p;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    const PlacedShape p = shapeOf(x);
    addBoxSides(p, residuals);
    const ObjectModel& m = *e_.model;
    residuals[4] = (p.shape.width - m.width_m) / std::max(m.width_sigma_m, 0.01);
    residuals[5] = (p.shape.depth - m.depth_m) / std::max(m.depth_sigma_m, 0.01);
    residuals[6] = (p.shape.height - m.height_m) / std::max(m.height_sigma_m, 0.01);
    residuals[7] = nearSideKnown() ? saturated((nearestRange(p) - near_range_) / (2 * sigma_point_), 3) : 0;
    // The directions of the sides, found in the points, say more about yaw than the box does.
    residuals[8] = round() ? 0 : wrapAngle(p.yaw - initial_.yaw) / (points_.empty() ? 0.4 : 0.08);
    const Pose3 object_from_ground = groundFromObject(p).inverse();
    const double weight =
        points_.empty() ? 0 : std::sqrt(kPointsWeight / static_cast<double>(points_.size()));
    for (std::size_t i = 0; i < points_.size(); ++i)
      residuals[kFixed + static_cast<Eigen::Index>(i)] =
          weight *
          saturated(distanceOutside(p.shape, object_from_ground * points_[i]).norm() / sigma_point_, 4);
    return 0;
  }

 private:
  bool round() const { return initial_.shape.kind == ShapeKind::kCylinder; }

  // What lies outside the image may be nearer than all that is seen.
  bool nearSideKnown() const {
    return !points_.empty() && (round() || !(e_.cut_left || e_.cut_right || e_.cut_bottom));
  }

  double nearestRange(const PlacedShape& p) const {
    if (round()) return std::hypot(p.x, p.y) - p.shape.radius();
    double nearest = 1e9;
    for (const auto& corner : footprint(p.shape)) {
      const Eigen::Vector2d c = Pose2{p.x, p.y, p.yaw} * corner;
      nearest = std::min(nearest, c.norm());
    }
    return nearest;
  }

  // A side at the image border says only that the model reaches the border there.
  void addBoxSides(const PlacedShape& p, Eigen::VectorXd& residuals) const {
    const auto projected = project(p, e_);
    if (!projected) {
      residuals.head<4>().setConstant(20);
      return;
    }
    const Box2 &seen = e_.box, &full = projected->full;
    const double su = 4 + 0.03 * seen.width(), sv = 4 + 0.03 * seen.height();
    const auto side = [](double outward, double sigma, bool cut) {
      return saturated((cut ? std::min(outward, 0.0) : outward) / sigma, 5);
    };
    residuals[0] = side(seen.u_min - full.u_min, su, e_.cut_left);
    residuals[1] = side(seen.v_min - full.v_min, sv, e_.cut_top);
    residuals[2] = side(full.u_max - seen.u_max, su, e_.cut_right);
    residuals[3] = side(full.v_max - seen.v_max, sv, e_.cut_bottom);
  }

  PlacedShape initial_;
  const BoxEvidence& e_;
  std::vector<Eigen::Vector3d> points_;
  double near_range_ = 0, sigma_point_ = 0.03;
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
  const double high = 0.8 * quantile(heights, 0.97);
  double sum = 0;
  int count = 0;
  for (const auto& q : middle) {
    if (q.z() < high) continue;
    sum += std::clamp(-2 * q.x() / placed.shape.depth, -1.0, 1.0);
    ++count;
  }
  return count >= 5 ? sum / count : 0;
}

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
  if (m.symmetry == 1 && placed.shape.kind == ShapeKind::kCuboid)
    placed.quality *= 0.55 + 0.45 * backRestAgreement(placed, evidence.mask.points);
}

PlacedShape fitShape(const PlacedShape& initial, const BoxEvidence& evidence) {
  Eigen::NumericalDiff<FitProblem> problem(FitProblem(initial, evidence), 1e-6);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<FitProblem>> solver(problem);
  solver.parameters.maxfev = 120;
  solver.parameters.xtol = solver.parameters.ftol = 1e-4;
  Eigen::VectorXd x = problem.vectorOf(initial);
  solver.minimize(x);
  PlacedShape fitted = x.allFinite() ? problem.shapeOf(x) : initial;
  judge(fitted, evidence);
  return fitted;
}

}  // namespace roomgraph
