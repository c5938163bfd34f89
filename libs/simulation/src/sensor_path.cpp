// SPDX-License-Identifier: BSD-3-Clause
// Catmull-Rom spline, smoothing, and timing under speed and acceleration limits.
#include "sensor_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr double kStep_m = 0.01;
using Vector = Eigen::VectorXd;

/// Point i of a sequence that is closed, or continues its first and last step.
Vector neighbour(const std::vector<Vector>& points, int i, bool closed) {
  const int n = static_cast<int>(points.size());
  if (closed) return points[static_cast<std::size_t>((i % n + n) % n)];
  if (i < 0) return 2 * points.front() - points[1];
  if (i >= n) return 2 * points.back() - points[static_cast<std::size_t>(n - 2)];
  return points[static_cast<std::size_t>(i)];
}

/// Centripetal Catmull-Rom spline (Yuksel et al. 2011: no loops) in `dimensions` whose first `metric` are
/// metres.
std::vector<Vector> spline(const std::vector<Vector>& points, bool closed, int metric) {
  std::vector<Vector> out;
  const int segments = static_cast<int>(points.size()) - (closed ? 0 : 1);
  for (int s = 0; s < segments; ++s) {
    const Vector p[4] = {neighbour(points, s - 1, closed), neighbour(points, s, closed),
                         neighbour(points, s + 1, closed), neighbour(points, s + 2, closed)};
    double knot[4] = {0, 0, 0, 0};
    for (int i = 1; i < 4; ++i)
      knot[i] = knot[i - 1] + std::max(1e-3, std::sqrt((p[i] - p[i - 1]).head(metric).norm()));
    const int steps = std::max(2, static_cast<int>((p[2] - p[1]).head(metric).norm() / kStep_m));
    for (int k = 0; k < steps; ++k) {
      const double t = knot[1] + (knot[2] - knot[1]) * k / steps;
      // Barry and Goldman's pyramid: each level blends neighbours over the knots that both depend on.
      const auto blend = [&](const Vector& a, const Vector& b, int from, int to) -> Vector {
        return (a * (knot[to] - t) + b * (t - knot[from])) / (knot[to] - knot[from]);
      };
      const Vector a1 = blend(p[0], p[1], 0, 1), a2 = blend(p[1], p[2], 1, 2), a3 = blend(p[2], p[3], 2, 3);
      out.push_back(blend(blend(a1, a2, 0, 2), blend(a2, a3, 1, 3), 1, 2));
    }
  }
  out.push_back(closed ? points.front() : points.back());
  return out;
}

/// The curve at equal steps of its first `metric` dimensions, averaged over +-half_width metres: continuous
/// curvature.
std::vector<Vector> evenAndSmooth(const std::vector<Vector>& curve, int metric, double half_width) {
  std::vector<Vector> even{curve.front()};
  double left = kStep_m;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    Vector from = curve[i - 1];
    double length = (curve[i] - from).head(metric).norm();
    while (length >= left) {
      from += (curve[i] - from) * (left / length);
      even.push_back(from);
      length -= left;
      left = kStep_m;
    }
    left -= length;
  }
  const int n = static_cast<int>(even.size()), reach = static_cast<int>(half_width / kStep_m);
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<Vector> smooth = even;
    for (int i = 0; i < n; ++i) {
      const int around = std::min({reach, i, n - 1 - i});
      Vector sum = Vector::Zero(even[0].size());
      for (int k = -around; k <= around; ++k) sum += even[static_cast<std::size_t>(i + k)];
      smooth[static_cast<std::size_t>(i)] = sum / (2 * around + 1);
    }
    even = std::move(smooth);
  }
  return even;
}

/// Length between two of the curve's points at steps of kStep_m. Where the curve turns back, smoothing has
/// moved them nearly into one place: there, their true distance, or the robot would turn faster than it may.
double span(const std::vector<Vector>& curve, std::size_t from, std::size_t to) {
  double length = 0;
  for (std::size_t i = from; i < to; ++i) length += (curve[i + 1] - curve[i]).norm();
  const double even = static_cast<double>(to - from) * kStep_m;
  return length < 0.8 * even ? std::max(length / 2, 1e-6) : even;
}

std::vector<double> speeds(const std::vector<double>& lengths, const std::vector<double>& limits,
                           double acceleration) {
  std::vector<double> v = limits;
  v.front() = v.back() = 0;
  for (std::size_t i = 1; i < v.size(); ++i)
    v[i] = std::min(v[i], std::sqrt(v[i - 1] * v[i - 1] + 2 * acceleration * lengths[i - 1]));
  for (std::size_t i = v.size() - 1; i-- > 0;)
    v[i] = std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] + 2 * acceleration * lengths[i]));
  return v;
}

/// Places on the curve at equal steps of time; between two of its points the acceleration is constant.
std::vector<SensorPath::Instant> timed(const std::vector<double>& lengths, const std::vector<double>& v,
                                       double step_s) {
  std::vector<SensorPath::Instant> out;
  double start = 0, next = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double duration = 2 * lengths[i] / (v[i] + v[i + 1]);
    const double a = (v[i + 1] - v[i]) / duration;
    for (; next < start + duration; next += step_s) {
      const double t = next - start;
      out.push_back({i, std::clamp((v[i] + a * t / 2) * t / lengths[i], 0.0, 1.0)});
    }
    start += duration;
  }
  return out;
}

}  // namespace

SensorPath::SensorPath(const RobotPathSpec& spec) {
  constexpr double kCusp_rad = 0.3, kTurnStep_rad = 0.02, kHalt_m_s = 0.02;
  const std::vector<Vector> points(spec.path_m.begin(), spec.path_m.end());
  const auto curve = evenAndSmooth(spline(points, spec.closed, 2), 2, 0.15);
  std::vector<double> yaw;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vector along = curve[std::min(i + 1, curve.size() - 1)] - curve[i == 0 ? 0 : i - 1];
    yaw.push_back(std::atan2(along.y(), along.x()));
  }
  std::vector<double> lengths, limits;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, curve.size() - 1);
    const double curvature = std::abs(wrapAngle(yaw[b] - yaw[a])) / span(curve, a, b);
    curve_.push_back(poseFromYpr(curve[i].x(), curve[i].y(), 0, yaw[i], 0, 0));
    limits.push_back(std::min(spec.max_speed_m_s, spec.max_turn_rad_s / std::max(1e-6, curvature)));
    if (i == b) break;
    // Where the curve turns back on itself the robot halts and turns on the spot, an angle for a length.
    const double turn = wrapAngle(yaw[b] - yaw[i]);
    const int steps = std::abs(turn) > kCusp_rad ? static_cast<int>(std::abs(turn) / kTurnStep_rad) : 0;
    if (steps > 0) limits.back() = std::min(limits.back(), kHalt_m_s);
    for (int k = 1; k <= steps; ++k) {
      lengths.push_back(kTurnStep_rad * spec.max_speed_m_s / spec.max_turn_rad_s);
      limits.push_back(k < steps ? spec.max_speed_m_s : kHalt_m_s);
      curve_.push_back(poseFromYpr(curve[i].x(), curve[i].y(), 0, yaw[i] + turn * k / steps, 0, 0));
    }
    lengths.push_back(std::max(1e-6, (curve[b] - curve[i]).norm()));
  }
  instants_ = timed(lengths, speeds(lengths, limits, spec.acceleration_m_s2), kStep_s);
}

SensorPath::SensorPath(const HandheldSpec& spec) {
  constexpr double kTurn_rad_s = 0.7, kAcceleration = 0.5;
  std::vector<Vector> points;
  for (const auto& key : spec.keys) {
    Vector point(6);
    // The view direction as a point at one metre, so that far and near targets turn the camera alike.
    point << key.at_m, key.at_m + (key.look_at_m - key.at_m).normalized();
    points.push_back(point);
  }
  const auto curve = evenAndSmooth(spline(points, spec.closed, 3), 3, 0.2);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector3d at = curve[i].head<3>(), view = curve[i].tail<3>() - at;
    const double s = kStep_m * static_cast<double>(i);
    // A hand never holds still: slow sway in roll and pitch.
    const double pitch = -std::atan2(view.z(), view.head<2>().norm()) + 0.015 * std::sin(5.1 * s);
    curve_.push_back(poseFromYpr(at.x(), at.y(), at.z() + 0.012 * std::sin(7.3 * s),
                                 std::atan2(view.y(), view.x()), pitch, 0.02 * std::sin(3.7 * s)));
  }
  std::vector<double> lengths, limits;
  for (std::size_t i = 0; i + 1 < curve_.size(); ++i) {
    const Pose3 step = curve_[i].inverse() * curve_[i + 1];
    lengths.push_back(std::max(1e-6, step.translation().norm()));
    limits.push_back(
        std::min(spec.speed_m_s, kTurn_rad_s * lengths.back() / std::max(1e-9, rotationAngle(step))));
  }
  limits.push_back(0);
  instants_ = timed(lengths, speeds(lengths, limits, kAcceleration), kStep_s);
}

Pose3 SensorPath::stateAt(std::size_t instant) const {
  if (instant >= instants_.size()) return curve_.back();
  const auto [segment, ratio] = instants_[instant];
  return interpolate(curve_[segment], curve_[segment + 1], ratio);
}

Pose3 SensorPath::at(double seconds) const {
  const double index = std::clamp(seconds / kStep_s, 0.0, static_cast<double>(instants_.size()));
  const auto low = static_cast<std::size_t>(index);
  return interpolate(stateAt(low), stateAt(low + 1), index - static_cast<double>(low));
}

}  // namespace roomgraph
