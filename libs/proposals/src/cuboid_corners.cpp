// SPDX-License-Identifier: BSD-3-Clause
// Corner construction with sampled yaw, vanishing lines and back-projection to the ground.
#include "cuboid_corners.h"

#include <cmath>
#include <numbers>

namespace roomgraph {
namespace {

constexpr int kYaws = 12;                   // samples over a quarter turn
constexpr int kCorners = 9;                 // samples of the first corner's position along the box's top
constexpr double kSizeGate = 2.5;           // standard deviations from the usual size
constexpr double kLeastSizeSigma_m = 0.02;  // of the usual size: the construction itself is no more accurate
constexpr double kShortestEdge_m = 0.05;    // a shorter bottom edge is seen nearly end-on
constexpr double kCornerSlack_px = 1;       // a corner may lie this far outside the box
constexpr double kParallel = 1e-9;          // relative; smaller: two lines of the image are parallel

using Line = Eigen::Vector3d;  // homogeneous
Eigen::Vector3d homogeneous(double u, double v) {
  return {u, v, 1};
}
Line column(double u) {
  return {1, 0, -u};
}
Line row(double v) {
  return {0, 1, -v};
}
std::optional<Eigen::Vector2d> meet(const Line& a, const Line& b) {
  const Eigen::Vector3d p = a.cross(b);
  if (std::abs(p.z()) < kParallel * p.norm()) return std::nullopt;
  return Eigen::Vector2d(p.head<2>() / p.z());
}

/// The two horizontal axes of a cuboid, pointing away from the camera (ground frame), and the vanishing points of
/// both and of the vertical.
struct Axes {
  Eigen::Vector2d left, right;
  Eigen::Vector3d vanish_left, vanish_right, vanish_up;
};

Axes axesAt(double angle, const BoxEvidence& e) {
  const double ahead = bearingOf(e);
  // The left axis is within a quarter turn to the left of the viewing direction, hence the other one to the right.
  const double left = ahead + angle, right = left - std::numbers::pi / 2;
  Axes a;
  a.left = {std::cos(left), std::sin(left)};
  a.right = {std::cos(right), std::sin(right)};
  const Eigen::Matrix3d image = e.camera.matrix() * e.camera_from_ground.linear();
  a.vanish_left = image * Eigen::Vector3d(a.left.x(), a.left.y(), 0);
  a.vanish_right = image * Eigen::Vector3d(a.right.x(), a.right.y(), 0);
  a.vanish_up = image.col(2);
  return a;
}

std::optional<Eigen::Vector2d> onGround(const Eigen::Vector2d& pixel, const BoxEvidence& e) {
  const auto hit = intersect(e.camera.ray(pixel.x(), pixel.y()), e.ground);
  if (!hit) return std::nullopt;
  const Eigen::Vector3d p = e.camera_from_ground.inverse() * *hit;
  if (p.norm() > kFarthestGround_m) return std::nullopt;
  return Eigen::Vector2d(p.head<2>());
}

// Top of the vertical edge nearest to the camera, from the first corner on the box's top side. With the camera below
// the top face the nearest corner is the highest in the image: the first corner itself. With the camera above it the
// first corner is the farthest one, and vanishing lines lead from it over the box's sides to the nearest.
std::optional<Eigen::Vector2d> nearTop(double u, const Axes& a, const BoxEvidence& e) {
  const Eigen::Vector3d first = homogeneous(u, e.box.v_min);
  if (e.ground.offset < e.model->height_m + e.model->height_sigma_m) return Eigen::Vector2d(first.head<2>());
  const auto left = meet(first.cross(a.vanish_right), column(e.box.u_min));
  const auto right = meet(first.cross(a.vanish_left), column(e.box.u_max));
  if (!left || !right) return std::nullopt;
  return meet(homogeneous(left->x(), left->y()).cross(a.vanish_left),
              homogeneous(right->x(), right->y()).cross(a.vanish_right));
}

// Length of the bottom edge from the nearest corner to the box's side; nothing when that face is not seen or the side
// is cut.
std::optional<double> lengthTo(double side, bool cut, const Eigen::Vector2d& near_pixel,
                               const Eigen::Vector2d& near, const Eigen::Vector2d& axis,
                               const Eigen::Vector3d& vanish, const BoxEvidence& e) {
  if (cut) return std::nullopt;
  const auto end = meet(homogeneous(near_pixel.x(), near_pixel.y()).cross(vanish), column(side));
  if (!end) return std::nullopt;
  const auto point = onGround(*end, e);
  if (!point) return std::nullopt;
  const double length = axis.dot(*point - near);
  return length > kShortestEdge_m ? std::optional(length) : std::nullopt;
}

bool usual(double value, double nominal, double sigma) {
  return std::abs(value - nominal) <= kSizeGate * std::max(sigma, kLeastSizeSigma_m);
}

/// Nearest bottom corner on the ground, and the sizes measured from it.
struct Corner {
  Eigen::Vector2d near = Eigen::Vector2d::Zero();
  std::optional<double> left, right;
  double height = 0;
};

std::optional<Corner> cornerAt(double u, const Axes& a, const BoxEvidence& e) {
  const auto top = nearTop(u, a, e);
  if (!top) return std::nullopt;
  const auto bottom = meet(homogeneous(top->x(), top->y()).cross(a.vanish_up), row(e.box.v_max));
  if (!bottom || bottom->x() < e.box.u_min - kCornerSlack_px || bottom->x() > e.box.u_max + kCornerSlack_px)
    return std::nullopt;
  const auto near = onGround(*bottom, e);
  if (!near) return std::nullopt;
  Corner c;
  c.near = *near;
  c.left = lengthTo(e.box.u_min, e.cut.left, *bottom, *near, a.left, a.vanish_left, e);
  c.right = lengthTo(e.box.u_max, e.cut.right, *bottom, *near, a.right, a.vanish_right, e);
  const Eigen::Vector3d ray = e.camera_from_ground.linear().transpose() * e.camera.ray(top->x(), top->y());
  c.height = e.cut.top ? e.model->height_m
                       : e.ground.offset + ray.z() * near->norm() / std::max(1e-6, ray.head<2>().norm());
  return c;
}

// The width is measured along the left axis, or along the right one; the front faces the camera.
std::optional<PlacedShape> placeAt(const Corner& c, bool width_left, const Axes& a, const BoxEvidence& e) {
  const ObjectModel& m = *e.model;
  const double left = c.left.value_or(width_left ? m.width_m : m.depth_m),
               right = c.right.value_or(width_left ? m.depth_m : m.width_m);
  PlacedShape placed;
  placed.shape = m.nominal();
  placed.shape.width = width_left ? left : right;
  placed.shape.depth = width_left ? right : left;
  placed.shape.height = c.height;
  if (!usual(placed.shape.width, m.width_m, m.width_sigma_m) ||
      !usual(placed.shape.depth, m.depth_m, m.depth_sigma_m) ||
      !usual(placed.shape.height, m.height_m, m.height_sigma_m))
    return std::nullopt;
  const Eigen::Vector2d center = c.near + left / 2 * a.left + right / 2 * a.right;
  const Eigen::Vector2d front = width_left ? a.right : a.left;
  placed.x = center.x();
  placed.y = center.y();
  placed.yaw = std::atan2(-front.y(), -front.x());
  placed.has_yaw = true;
  placed.source = "vanishing points";
  return placed;
}

}  // namespace

std::vector<PlacedShape> cuboidsFromCorners(const BoxEvidence& e) {
  std::vector<PlacedShape> out;
  if (e.cut.bottom || e.box.empty() || !e.model->rests_on_ground) return out;
  for (int i = 0; i < kYaws; ++i) {
    const Axes axes = axesAt((i + 0.5) * std::numbers::pi / 2 / kYaws, e);
    for (int k = 0; k < kCorners; ++k) {
      const auto corner = cornerAt(e.box.u_min + e.box.width() * k / (kCorners - 1), axes, e);
      if (!corner) continue;
      for (const bool width_left : {true, false})
        if (const auto placed = placeAt(*corner, width_left, axes, e)) out.push_back(*placed);
    }
  }
  return out;
}

}  // namespace roomgraph
