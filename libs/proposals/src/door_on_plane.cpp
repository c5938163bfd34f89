// SPDX-License-Identifier: BSD-3-Clause
// Least-squares interval with cut ends, projection of columns onto the plane, and covariance.
#include "door_on_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kEdgeOn = 0.03;       // least sine of the angle between a line of sight and the plane
constexpr double kVague_m = 3;         // standard deviation of the centre when neither end was seen
constexpr double kLeastWidth_m = 0.2;  // no door is narrower
// Standard deviations added when hardly any of the points are inliers of the plane; less by the square of their share.
constexpr double kDoubt_m = 0.3, kDoubt_rad = 0.5;

// Where a pixel's line of sight meets the plane: coordinate along it, and its change per pixel.
struct PlaneHit {
  double at = 0, per_px = 0;
};

std::optional<PlaneHit> hitOf(const BoxEvidence& e, const VerticalPlane& plane, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = e.camera_from_ground.linear().transpose() * e.camera.ray(pixel.x(), pixel.y());
  const Eigen::Vector2d d = ray.head<2>().normalized();
  const double slope = plane.normal.dot(d);
  if (slope > -kEdgeOn) return std::nullopt;
  const double range = plane.offset / slope;
  return PlaneHit{plane.along().dot(range * d), range / -slope / (e.camera.fx * ray.head<2>().norm())};
}

// The sides of the box that upright edges lie along: left and right, or of a camera that lies on its side top and bottom.
struct UprightSides {
  std::array<Eigen::Vector2d, 2> first, second;  // corners, px
  double apart_px = 0;
  bool first_cut = false, second_cut = false;
};

UprightSides uprightSides(const BoxEvidence& e) {
  const Box2& box = e.box;
  const Eigen::Vector2d top_left(box.u_min, box.v_min), top_right(box.u_max, box.v_min), bottom_left(box.u_min, box.v_max),
      bottom_right(box.u_max, box.v_max);
  const Eigen::Vector3d up = e.camera_from_ground.linear().col(2);
  if (std::abs(up.x()) > std::abs(up.y()))
    return {{top_left, top_right}, {bottom_left, bottom_right}, box.height(), e.cut.top, e.cut.bottom};
  return {{top_left, bottom_left}, {top_right, bottom_right}, box.width(), e.cut.left, e.cut.right};
}

// The upright edge that a side of the box touches. A camera that looks down sees upright edges diverge
// upwards, so that the box's side touches one of its ends only: of the hits of both corners, the one nearer
// to the box's middle.
std::optional<PlaneHit> edgeAt(const BoxEvidence& e, const VerticalPlane& plane, const std::array<Eigen::Vector2d, 2>& side) {
  const auto one = hitOf(e, plane, side[0]), other = hitOf(e, plane, side[1]), middle = hitOf(e, plane, e.box.center());
  if (!one || !other || !middle) return std::nullopt;
  return std::abs(one->at - middle->at) < std::abs(other->at - middle->at) ? one : other;
}

SeenInterval seenBetween(const PlaneHit& first, const PlaneHit& second, const UprightSides& sides) {
  const double px = sideSigma(sides.apart_px);
  SeenInterval out{first.at, second.at, px * first.per_px, px * second.per_px, sides.first_cut, sides.second_cut};
  // Depending on the side of the plane, its coordinate grows from the first side to the second or the other way.
  if (out.low > out.high) {
    std::swap(out.low, out.high);
    std::swap(out.low_sigma, out.high_sigma);
    std::swap(out.low_cut, out.high_cut);
  }
  return out;
}

// Information matrix and vector of (centre, width).
struct Normal {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  void add(const Eigen::Vector2d& row, double value, double sigma) {
    information += row * row.transpose() / (sigma * sigma);
    right += row * value / (sigma * sigma);
  }
};

Interval solve(const SeenInterval& seen, bool use_low, bool use_high, double usual, double sigma) {
  Normal normal;
  normal.add({0, 1}, usual, sigma);
  if (use_low) normal.add({1, -0.5}, seen.low, seen.low_sigma);
  if (use_high) normal.add({1, 0.5}, seen.high, seen.high_sigma);
  if (!use_low && !use_high) normal.add({1, 0}, (seen.low + seen.high) / 2, kVague_m);
  const Eigen::Vector2d x = normal.information.ldlt().solve(normal.right);
  const Eigen::Matrix2d covariance = normal.information.inverse();
  return {x[0], x[1], std::sqrt(covariance(0, 0)), std::max(0.0, 1 / covariance(1, 1) - 1 / (sigma * sigma)),
          covariance(0, 1) / covariance(1, 1)};
}

// Covariance of (x, y, yaw). An error of the plane's offset moves the door along the line of sight, since the box's
// sides fix its direction.
Eigen::Matrix3d covarianceOn(const VerticalPlane& plane, const Interval& along, const Eigen::Vector2d& place,
                             double seat_sigma) {
  const double doubt = std::pow(1 - plane.inlier_share, 2);
  const double yaw = plane.sigma_rad + kDoubt_rad * doubt;
  const double lever = along.center - plane.middle;  // the offset is most accurate at the points' middle
  const double offset = std::hypot(plane.sigma_m + kDoubt_m * doubt, lever * plane.sigma_rad);
  const Eigen::Vector2d sight = place.normalized() / std::max(kEdgeOn, -plane.normal.dot(place.normalized()));
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  out.topLeftCorner<2, 2>() = std::pow(offset, 2) * sight * sight.transpose() +
                              std::pow(seat_sigma, 2) * plane.normal * plane.normal.transpose() +
                              std::pow(along.center_sigma, 2) * plane.along() * plane.along().transpose();
  out(2, 2) = yaw * yaw;
  return out;
}

}  // namespace

Interval fitInterval(const SeenInterval& seen, double usual_width, double width_sigma) {
  bool use_low = !seen.low_cut, use_high = !seen.high_cut;
  Interval out = solve(seen, use_low, use_high, usual_width, width_sigma);
  // A cut end is a lower bound of the extent: used when the solution falls short of it.
  const bool low_short = !use_low && out.center - out.width / 2 > seen.low;
  const bool high_short = !use_high && out.center + out.width / 2 < seen.high;
  if (low_short || high_short)
    out = solve(seen, use_low || low_short, use_high || high_short, usual_width, width_sigma);
  return out;
}

void standOn(PlacedShape& door, const VerticalPlane& plane, double along_m, double seat_m) {
  const Eigen::Vector2d on_plane = plane.normal * plane.offset + plane.along() * along_m;
  const Eigen::Vector2d middle = on_plane - plane.normal * seat_m;
  door.x = middle.x();
  door.y = middle.y();
  door.yaw = std::atan2(plane.normal.y(), plane.normal.x());
  door.has_yaw = true;
}

std::optional<PlacedShape> doorOnPlane(const VerticalPlane& plane, const BoxEvidence& e, double seat_m) {
  const UprightSides sides = uprightSides(e);
  const auto first = edgeAt(e, plane, sides.first), second = edgeAt(e, plane, sides.second);
  if (!first || !second) return std::nullopt;
  const Interval along =
      fitInterval(seenBetween(*first, *second, sides), e.model->width_m, e.model->sizeSigma()[0]);
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.shape.width = std::max(kLeastWidth_m, along.width);
  placed.size_information[0] = along.width_information;
  placed.place_by_size(1, 0) = along.center_by_width;
  standOn(placed, plane, along.center, seat_m);
  const Eigen::Vector2d on_plane = plane.normal * plane.offset + plane.along() * along.center;
  placed.covariance = covarianceOn(plane, along, on_plane, seat_m);
  return placed;
}

}  // namespace roomgraph
