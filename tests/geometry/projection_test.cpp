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
    const Box2 visible = clipped(full, kTallPixels.width, kTallPixels.height);
    ASSERT_EQ(projected.has_value(), !visible.empty());
    if (!projected) continue;
    ++seen;
    expectNear(projected->full, full, 0.05);
    expectNear(projected->visible, visible, 0.05);
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
  for (int round = 0; round < 150; ++round) {
    const ObjectShape shape = randomShape(random);
    Pose3 pose = random.pose(0);
    pose.translation() =
        Eigen::Vector3d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-0.8, 1));
    const auto full = sampledBounds(shape, pose, 20000);
    const auto projected = projectShape(shape, pose, kTallPixels);
    if (!full) continue;
    const Box2 visible = clipped(*full, kTallPixels.width, kTallPixels.height);
    if (visible.width() < 3 || visible.height() < 3) continue;  // its border decides whether there is any
    ++partly;
    ASSERT_TRUE(projected.has_value());
    // A round shape stands for itself as a prism with 48 sides here: off by r (1 - cos(pi / 48)) < .3 %.
    expectNear(projected->visible, visible, shape.kind == ShapeKind::kCylinder ? 12 : 1);
  }
  EXPECT_GT(partly, 60);
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
