// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include <algorithm>
#include <cmath>
#include <random>

#include "roomgraph/proposals/fit_shape.h"
#include "roomgraph/proposals/generators.h"
#include "roomgraph/proposals/plane_fit.h"

namespace roomgraph {
namespace {

constexpr double kMinHeight = 0.15;  // m; lower points may be floor
constexpr int kTries = 120;
constexpr double kFarthest = 20;  // m

/// Vertical plane as a line in the ground frame: normal . p = offset, normal towards the camera (offset < 0).
struct VerticalPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0;
  int inliers = 0;
};

std::vector<Eigen::Vector2d> footprintPoints(const BoxEvidence& e) {
  const double inset = 0.08 * e.box.width();  // the frame's edges belong to the wall
  std::vector<Eigen::Vector2d> points;
  for (const auto& p : e.all.points)
    if (p.in_ground.z() > kMinHeight && p.u > e.box.u_min + inset && p.u < e.box.u_max - inset)
      points.push_back(p.in_ground.head<2>());
  return points;
}

double bandAt(const Eigen::Vector2d& p) {
  return 0.02 + 2.5 * depthSigma(p.norm());
}

VerticalPlane countInliers(VerticalPlane plane, const std::vector<Eigen::Vector2d>& points) {
  plane.inliers = static_cast<int>(std::count_if(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return std::abs(plane.normal.dot(p) - plane.offset) < bandAt(p);
  }));
  return plane;
}

VerticalPlane through(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = (b - a).normalized();
  VerticalPlane plane;
  plane.normal = {-along.y(), along.x()};
  plane.offset = plane.normal.dot(a);
  if (plane.offset > 0) {
    plane.normal = -plane.normal;
    plane.offset = -plane.offset;
  }
  return plane;
}

// Total least squares on the inliers.
VerticalPlane refine(const VerticalPlane& initial, const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  double n = 0;
  for (const auto& p : points)
    if (std::abs(initial.normal.dot(p) - initial.offset) < bandAt(p)) {
      mean += p;
      second += p * p.transpose();
      ++n;
    }
  if (n < 2) return initial;
  mean /= n;
  const Eigen::Matrix2d scatter = second / n - mean * mean.transpose();
  const double angle = 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
  return countInliers(through(mean, mean + Eigen::Vector2d(std::cos(angle), std::sin(angle))), points);
}

std::optional<VerticalPlane> findPlane(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 30) return std::nullopt;
  std::mt19937 random(777);
  VerticalPlane best;
  for (int i = 0; i < kTries; ++i) {
    const Eigen::Vector2d a = points[random() % points.size()], b = points[random() % points.size()];
    if ((b - a).norm() < 0.1) continue;
    const VerticalPlane plane = countInliers(through(a, b), points);
    if (plane.inliers > best.inliers) best = plane;
  }
  if (best.inliers < 0.35 * static_cast<double>(points.size())) return std::nullopt;
  return refine(best, points);
}

// Where a column of the image (at the box's middle row) meets the plane, as a coordinate along its horizontal
// line.
std::optional<double> columnOnPlane(const BoxEvidence& e, const VerticalPlane& plane, double u) {
  const Eigen::Vector3d ray = e.camera_from_ground.linear().transpose() * e.camera.ray(u, e.box.center().y());
  const double slope = plane.normal.dot(ray.head<2>());
  if (slope > -1e-3 * ray.norm()) return std::nullopt;
  const Eigen::Vector2d hit = plane.offset / slope * ray.head<2>();
  return Eigen::Vector2d(-plane.normal.y(), plane.normal.x()).dot(hit);
}

// Interval on the plane between the box's sides. A side at the image border says little: then the usual width
// counts from the other one; otherwise observed and usual width are weighed.
std::optional<PlacedShape> rectangleOn(const BoxEvidence& e, const VerticalPlane& plane) {
  const auto left = columnOnPlane(e, plane, e.box.u_min), right = columnOnPlane(e, plane, e.box.u_max);
  if (!left || !right) return std::nullopt;
  const double low = std::min(*left, *right), high = std::max(*left, *right), seen = high - low;
  const double usual = e.model->width_m, sigma = std::max(0.02, e.model->width_sigma_m),
               seen_sigma = 0.03 + 0.04 * seen;
  // The left image side is the low end when the coordinate grows to the right, and the reverse.
  const bool low_cut = *left < *right ? e.cut_left : e.cut_right,
             high_cut = *left < *right ? e.cut_right : e.cut_left;
  const double ratio = sigma * sigma / (sigma * sigma + seen_sigma * seen_sigma);
  const double width = low_cut || high_cut ? std::max(usual, seen) : usual + ratio * (seen - usual);
  double center = (low + high) / 2;
  if (low_cut && !high_cut) center = high - width / 2;
  if (high_cut && !low_cut) center = low + width / 2;
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.shape.width = width;
  const Eigen::Vector2d along(-plane.normal.y(), plane.normal.x());
  const Eigen::Vector2d p = plane.normal * plane.offset + along * center;
  placed.x = p.x();
  placed.y = p.y();
  placed.yaw = std::atan2(plane.normal.y(), plane.normal.x());
  placed.has_yaw = true;
  placed.source = "depth plane";
  return placed;
}

// The frame's edge near a side of the box: the longest steep segment there; else the side itself.
double frameEdge(const BoxEvidence& e, double side) {
  for (const Segment2& s : e.segments) {  // longest first
    const Eigen::Vector2d along = s.b - s.a;
    if (std::abs(along.x()) < 0.15 * std::abs(along.y()) && along.norm() > 0.3 * e.box.height() &&
        std::abs((s.a.x() + s.b.x()) / 2 - side) < 0.12 * e.box.width())
      return (s.a.x() + s.b.x()) / 2;
  }
  return side;
}

std::optional<Eigen::Vector2d> onGround(const BoxEvidence& e, double u, double v) {
  const auto point = intersect(e.camera.ray(u, v), e.ground);
  if (!point || point->norm() > kFarthest) return std::nullopt;
  return Eigen::Vector2d((e.camera_from_ground.inverse() * *point).head<2>());
}

// A door's leaf between two points of the ground.
PlacedShape between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const BoxEvidence& e) {
  const VerticalPlane plane = through(a, b);
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.shape.width = (b - a).norm();
  placed.x = (a.x() + b.x()) / 2;
  placed.y = (a.y() + b.y()) / 2;
  placed.yaw = std::atan2(plane.normal.y(), plane.normal.x());
  placed.has_yaw = true;
  placed.source = "frame edges";
  return placed;
}

// Without a plane: the nearer lower corner is on the box's bottom side, the other one on the other side's
// column, a usual width away. Which of both is nearer is not known; each may have two solutions.
std::vector<PlacedShape> fromFrame(const BoxEvidence& e) {
  std::vector<PlacedShape> out;
  if (e.cut_bottom || e.cut_left || e.cut_right) return out;
  const double left = frameEdge(e, e.box.u_min), right = frameEdge(e, e.box.u_max), w = e.model->width_m;
  for (const auto& [near_u, far_u] : {std::pair{left, right}, std::pair{right, left}}) {
    const auto near = onGround(e, near_u, e.box.v_max), far = onGround(e, far_u, e.box.v_max);
    if (!near || !far) continue;
    // |s d - near| = w with s >= |far|: the far corner is seen higher in the image.
    const Eigen::Vector2d d = far->normalized();
    const double middle = d.dot(*near), root = w * w - near->squaredNorm() + middle * middle;
    if (root < 0) continue;
    for (const double s : {middle - std::sqrt(root), middle + std::sqrt(root)})
      if (s > 0.98 * far->norm()) out.push_back(between(*near, s * d, e));
    out.push_back(between(*near, *far, e));  // both on the bottom side
  }
  return out;
}

// Nothing but the box's bottom: facing the camera above it.
std::optional<PlacedShape> facingCamera(const BoxEvidence& e) {
  const auto contact = contactPoint(e);
  if (!contact || contact->norm() < 0.1) return std::nullopt;
  PlacedShape placed;
  placed.shape = e.model->nominal();
  placed.x = contact->x();
  placed.y = contact->y();
  placed.yaw = std::atan2(-contact->y(), -contact->x());
  placed.source = "contact";
  return placed;
}

// Adjusts the height to the box's top when that is in view.
void adjustHeight(PlacedShape& placed, const BoxEvidence& e) {
  if (e.cut_top) return;
  const Eigen::Vector3d ray =
      e.camera_from_ground.linear().transpose() * e.camera.ray(e.box.center().x(), e.box.v_min);
  const double range = std::hypot(placed.x, placed.y),
               camera_height = e.camera_from_ground.inverse().translation().z();
  const double seen = camera_height + ray.z() / ray.head<2>().norm() * range;
  const double low = e.model->height_m - 2 * e.model->height_sigma_m,
               high = e.model->height_m + 2 * e.model->height_sigma_m;
  placed.shape.height = std::clamp((seen + e.model->height_m) / 2, low, high);
}

}  // namespace

std::vector<PlacedShape> doorHypotheses(const BoxEvidence& evidence, const GeneratorLimits& limits) {
  std::vector<PlacedShape> guesses;
  const auto plane = findPlane(footprintPoints(evidence));
  if (plane) {
    if (const auto placed = rectangleOn(evidence, *plane)) guesses.push_back(*placed);
  } else {
    guesses = fromFrame(evidence);
    if (const auto placed = facingCamera(evidence)) guesses.push_back(*placed);
  }
  for (PlacedShape& placed : guesses) {
    placed.supported = plane.has_value();
    adjustHeight(placed, evidence);
    judge(placed, evidence);
  }
  return keepBest(guesses, 0.05, 0.1, limits);
}

}  // namespace roomgraph
