// SPDX-License-Identifier: BSD-3-Clause
// Projected shapes and circles against sampled outlines.
#include "roomgraph/geometry/projection.h"

#include <gtest/gtest.h>

#include <numbers>

#include "random_poses.h"
#include "roomgraph/geometry/projected_bounds.h"

namespace roomgraph {
namespace {

using test::Random;

const PinholeCamera kTallPixels{640, 480, 525, 480, 319.5, 239.5, {}};
constexpr double kNear = 0.05;

// Every point that can lie on the outline of the model in front of the near plane: its edges (of a cylinder:
// rims and lines of the side), finely sampled.
std::vector<Eigen::Vector3d> outline(const ObjectShape& shape, int per_edge) {
  std::vector<Eigen::Vector3d> points;
  const bool round = shape.kind == ShapeKind::kCylinder;
  const auto base = footprint(shape, round ? 720 : 4);
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Eigen::Vector2d &a = base[i], &b = base[(i + 1) % base.size()];
    const int along = round ? 2 : per_edge;
    for (int k = 0; k <= along; ++k) {
      const Eigen::Vector2d p = a + (b - a) * k / along;
      points.emplace_back(p.x(), p.y(), 0);
      points.emplace_back(p.x(), p.y(), shape.height);
    }
    const int upwards = round ? 400 : per_edge;
    for (int k = 0; k <= upwards; ++k) points.emplace_back(a.x(), a.y(), shape.height * k / upwards);
  }
  return points;
}

std::optional<Box2> sampledBounds(const ObjectShape& shape, const Pose3& camera_from_object, int per_edge) {
  Box2 box{1e9, 1e9, -1e9, -1e9};
  for (const auto& point : outline(shape, per_edge)) {
    const Eigen::Vector3d p = camera_from_object * point;
    if (p.z() < kNear) continue;
    const Eigen::Vector2d pixel = kTallPixels.project(p);
    box = {std::min(box.u_min, pixel.x()), std::min(box.v_min, pixel.y()), std::max(box.u_max, pixel.x()),
           std::max(box.v_max, pixel.y())};
  }
  return box.empty() ? std::nullopt : std::optional(box);
}

ObjectShape randomShape(Random& random) {
  const int kind = random.index(3);
  const double width = random.uniform(0.4, 2), height = random.uniform(0.4, 2.1);
  if (kind == 0) return {ShapeKind::kCylinder, width, width, height};
  return {kind == 1 ? ShapeKind::kCuboid : ShapeKind::kPlanar, width,
          kind == 1 ? random.uniform(0.4, 1) : 0.05, height};
}

void expectNear(const Box2& a, const Box2& b, double tolerance) {
  EXPECT_NEAR(a.u_min, b.u_min, tolerance);
  EXPECT_NEAR(a.v_min, b.v_min, tolerance);
  EXPECT_NEAR(a.u_max, b.u_max, tolerance);
  EXPECT_NEAR(a.v_max, b.v_max, tolerance);
}

TEST(ProjectShape, InFrontEqualsSampling) {
  Random random(1);
  int seen = 0, cut = 0;
  for (int round = 0; round < 300; ++round) {
    const ObjectShape shape = randomShape(random);
    Pose3 pose = random.pose(0);
    pose.translation() =
        Eigen::Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(2.8, 7));
    const auto projected = projectShape(shape, pose, kTallPixels);
    const Box2 full = *sampledBounds(shape, pose, 3);
    if (clipped(full, kTallPixels.width, kTallPixels.height).empty()) {
      EXPECT_FALSE(projected.has_value());
    }
    if (!projected) continue;
    ++seen;
    expectNear(projected->full, full, 0.05);
    if (!projected->cut.any()) expectNear(projected->visible, full, 0.05);
    EXPECT_EQ(projected->cut.left, full.u_min < 0);
    EXPECT_EQ(projected->cut.top, full.v_min < 0);
    EXPECT_EQ(projected->cut.right, full.u_max > kTallPixels.width);
    EXPECT_EQ(projected->cut.bottom, full.v_max > kTallPixels.height);
    cut += projected->cut.any();
  }
  EXPECT_GT(seen, 200);
  EXPECT_GT(cut, 30);
  EXPECT_LT(cut, seen);
}

TEST(ProjectShape, PartlyBehindTheCameraEqualsSampling) {
  Random random(2);
  int partly = 0;
  for (int round = 0; round < 200; ++round) {
    const ObjectShape shape = randomShape(random);
    Pose3 pose = random.pose(0);
    pose.translation() =
        Eigen::Vector3d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-0.8, 1));
    const auto full = sampledBounds(shape, pose, 20000);
    const auto projected = projectShape(shape, pose, kTallPixels);
    if (!full) continue;
    if (!projected) continue;  // outside the image
    ++partly;
    // A round shape stands for itself as a prism with 48 sides here: off by r (1 - cos(pi / 48)) < .3 %.
    const double most = shape.kind == ShapeKind::kCylinder ? 12 : 1;
    expectNear(clipped(projected->full, kTallPixels.width, kTallPixels.height),
               clipped(*full, kTallPixels.width, kTallPixels.height), most);
  }
  EXPECT_GT(partly, 60);
}

// Whether the line of sight through a pixel meets the model in front of the near plane: intervals of depth in which it is
// between the planes of a box, or in a cylinder.
bool isCovered(double u, double v, const ObjectShape& shape, const Pose3& object_from_camera) {
  const Eigen::Vector3d origin = object_from_camera.translation(),
                        along = object_from_camera.linear() * kTallPixels.backProject(u, v, 1);
  double from = kNear, to = 1e9;
  const auto between = [&](double start, double slope, double low, double high) {
    if (std::abs(slope) < 1e-12) {
      if (start < low || start > high) to = -1;
      return;
    }
    from = std::max(from, std::min((low - start) / slope, (high - start) / slope));
    to = std::min(to, std::max((low - start) / slope, (high - start) / slope));
  };
  between(origin.z(), along.z(), 0, shape.height);
  if (shape.kind != ShapeKind::kCylinder) {
    between(origin.x(), along.x(), -shape.depth / 2, shape.depth / 2);
    between(origin.y(), along.y(), -shape.width / 2, shape.width / 2);
    return from <= to;
  }
  const double a = along.head<2>().squaredNorm(), b = origin.head<2>().dot(along.head<2>()),
               c = origin.head<2>().squaredNorm() - shape.radius() * shape.radius(), root = b * b - a * c;
  if (root < 0) return false;
  from = std::max(from, (-b - std::sqrt(root)) / a);
  to = std::min(to, (-b + std::sqrt(root)) / a);
  return from <= to;
}

TEST(ProjectShape, WhatIsVisibleIsWhatLinesOfSightMeet) {
  constexpr double kStep_px = 2;
  Random random(4);
  int cut = 0;
  for (int round = 0; round < 150; ++round) {
    const ObjectShape shape = randomShape(random);
    Pose3 pose = random.pose(0);
    pose.translation() = Eigen::Vector3d(random.uniform(-1.5, 1.5), random.uniform(-1.2, 1.2), random.uniform(0.9, 2.5));
    const auto projected = projectShape(shape, pose, kTallPixels);
    const Pose3 object_from_camera = pose.inverse();
    Box2 met{1e9, 1e9, -1e9, -1e9};
    for (double v = 0; v <= kTallPixels.height; v += kStep_px)
      for (double u = 0; u <= kTallPixels.width; u += kStep_px)
        if (isCovered(u, v, shape, object_from_camera))
          met = {std::min(met.u_min, u), std::min(met.v_min, v), std::max(met.u_max, u), std::max(met.v_max, v)};
    if (met.width() < 20 || met.height() < 20) continue;  // a sharp tip is missed by the grid
    ASSERT_TRUE(projected.has_value());
    if (!projected->cut.any()) continue;
    ++cut;
    const double most = shape.kind == ShapeKind::kCuboid ? 5 : 9;  // the grid's step at a slanted tip; a thin or a many-sided one
    expectNear(projected->visible, met, most);
    EXPECT_LE(projected->visible.area(), clipped(projected->full, kTallPixels.width, kTallPixels.height).area() + 1);
  }
  EXPECT_GT(cut, 60);
}

// A long box that goes from the view to beside the camera: its nearest corner is outside the image, and so is how low it
// reaches. At the image's left border, 30 deg to the left, it is farther.
TEST(ProjectShape, TheLowestVisiblePointIsInsideTheImage) {
  const PinholeCamera camera{640, 480, 320 * std::sqrt(3.0), 320 * std::sqrt(3.0), 320, 240, {}};
  Pose3 pose = Pose3::Identity();  // object frame: x ahead, y left, z up; the front side is 2 m ahead of the camera
  pose.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  pose.translation() = Eigen::Vector3d(-2, 1, 2.5);  // its right end is in the image's middle
  const ObjectShape shape{ShapeKind::kCuboid, 4, 1, 0.8};
  Pose3 turned = pose;
  turned.linear() = Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY()).toRotationMatrix() * pose.linear();
  for (const Pose3& p : {pose, turned}) {
    const auto projected = projectShape(shape, p, camera);
    ASSERT_TRUE(projected);
    double lowest = 0;  // of the front side's lower edge, inside the image
    for (int k = 0; k <= 4000; ++k) {
      const Eigen::Vector3d q = p * Eigen::Vector3d(-0.5, -2 + 4.0 * k / 4000, 0);
      if (q.z() > kNear && camera.project(q).x() >= 0) lowest = std::max(lowest, camera.project(q).y());
    }
    EXPECT_NEAR(projected->visible.v_max, std::min(lowest, 480.0), 1);
  }
}

TEST(ProjectShape, BehindOrBesideGivesNothing) {
  const ObjectShape shape{ShapeKind::kCuboid, 1, 1, 1};
  Pose3 pose = Pose3::Identity();
  pose.translation().z() = -3;
  EXPECT_FALSE(projectShape(shape, pose, kTallPixels).has_value());
  pose.translation() = Eigen::Vector3d(20, 0, 3);
  EXPECT_FALSE(projectShape(shape, pose, kTallPixels).has_value());
}

TEST(CircleBounds, EqualSampling) {
  Random random(3);
  int in_front = 0;
  for (int round = 0; round < 200; ++round) {
    const Eigen::Vector3d center(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.2, 4));
    const Eigen::Vector3d normal = random.direction();
    const double radius = random.uniform(0.1, 0.8);
    const Eigen::Vector3d e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
    Box2 sampled{1e9, 1e9, -1e9, -1e9};
    double nearest = 1e9;
    for (int k = 0; k < 20000; ++k) {
      const double angle = 2 * std::numbers::pi * k / 20000;
      const Eigen::Vector3d p = center + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
      nearest = std::min(nearest, p.z());
      const Eigen::Vector2d pixel = kTallPixels.project(p);
      sampled = {std::min(sampled.u_min, pixel.x()), std::min(sampled.v_min, pixel.y()),
                 std::max(sampled.u_max, pixel.x()), std::max(sampled.v_max, pixel.y())};
    }
    if (nearest < 0.05) continue;
    ++in_front;
    const auto u = circleBounds(center, normal, radius, 0, kTallPixels.fx, kTallPixels.cx);
    const auto v = circleBounds(center, normal, radius, 1, kTallPixels.fy, kTallPixels.cy);
    expectNear({u[0], v[0], u[1], v[1]}, sampled, 0.05);
  }
  EXPECT_GT(in_front, 100);
}

TEST(CircleBounds, ACircleSeenEdgeOnHasNoWidth) {
  // In the plane x = 0 through the camera's centre: its image is a line u = cx.
  const auto u = circleBounds<double>({0, 0, 3}, {1, 0, 0}, 0.5, 0, kTallPixels.fx, kTallPixels.cx);
  EXPECT_NEAR(u[0], kTallPixels.cx, 1e-9);
  EXPECT_NEAR(u[1], kTallPixels.cx, 1e-9);
}

}  // namespace
}  // namespace roomgraph
