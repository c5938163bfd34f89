// SPDX-License-Identifier: BSD-3-Clause
// OrbitCamera: projection against the rays through pixels, hand-worked places, fit, and the view behind a
// robot.
#include "roomgraph/rendering/orbit_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roomgraph/geometry/degree.h"

namespace roomgraph::test {
namespace {

using Ray = OrbitCamera::Ray;

Eigen::Vector3d somePoint(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> in(-reach, reach);
  return {in(random), in(random), in(random)};
}

OrbitCamera someCamera(bool orthographic) {
  OrbitCamera out{.distance = 8, .azimuth = -1.1, .elevation = 0.7, .orthographic = orthographic};
  out.target = {1, 2, 0.3};
  out.width = 940;
  out.height = 756;
  return out;
}

TEST(OrbitCamera, TheRayThroughAPixelHoldsThePointsThatAreSeenThere) {
  std::mt19937 random(5);
  for (const bool orthographic : {false, true}) {
    const OrbitCamera view = someCamera(orthographic);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d world = view.target + somePoint(random, 3);
      const auto pixel = view.project(world);
      ASSERT_TRUE(pixel.has_value());
      const Ray ray = view.rayThrough(*pixel);
      EXPECT_LT(ray.distance(world), 1e-9);
      EXPECT_GT(ray.direction().dot(world - ray.origin()), 0) << "in front of the camera";
      EXPECT_NEAR(ray.direction().norm(), 1, 1e-12);
    }
  }
}

TEST(OrbitCamera, ItsTargetIsInTheMiddleAndUpIsUp) {
  for (const bool orthographic : {false, true}) {
    const OrbitCamera view = someCamera(orthographic);
    EXPECT_LT((*view.project(view.target) - Eigen::Vector2d(470, 378)).norm(), 1e-9);
    EXPECT_LT(view.project(view.target + Eigen::Vector3d(0, 0, 1))->y(), 378);
  }
  const OrbitCamera view = someCamera(false);
  const Eigen::Vector3d to_camera(std::cos(-1.1) * std::cos(0.7), std::sin(-1.1) * std::cos(0.7),
                                  std::sin(0.7));
  EXPECT_FALSE(view.project(view.target + 9 * to_camera)) << "behind the camera";
  // At 8 m, half the picture's height is 8 m * tan(15 degrees).
  const Eigen::Vector3d up(-std::cos(-1.1) * std::sin(0.7), -std::sin(-1.1) * std::sin(0.7), std::cos(0.7));
  EXPECT_NEAR(view.project(view.target + 8 * std::tan(15 * kDegree) * up)->y(), 0, 1e-6);
}

TEST(OrbitCamera, FromAboveMetresAreThatManyPixels) {
  OrbitCamera view = someCamera(true);
  view.azimuth = -M_PI / 2;
  view.elevation = M_PI / 2;
  // Half the smaller side is a quarter of the distance.
  EXPECT_NEAR(view.pixelsPerMeter(), 756 / 4., 1e-9);
  const Eigen::Vector2d one = *view.project({2, 2, 0}), origin = *view.project({1, 2, 0});
  EXPECT_LT((one - origin - Eigen::Vector2d(756 / 4., 0)).norm(), 1e-6) << "x to the right";
}

TEST(OrbitCamera, FitsWhatItIsGivenIntoTheBox) {
  const std::vector<Eigen::Vector3d> content{{0, 0, 0}, {6, 1, 0}, {3, 4, 1}, {5, 5, 0}};
  const Box2 inner{40, 30, 900, 700};
  for (const bool orthographic : {false, true}) {
    OrbitCamera view = someCamera(orthographic);
    view.fit(content, inner);
    Eigen::AlignedBox2d image;
    for (const auto& point : content) image.extend(*view.project(point));
    const double fill = std::max(image.sizes().x() / inner.width(), image.sizes().y() / inner.height());
    EXPECT_NEAR(fill, 1, 0.01);
    EXPECT_LT((image.center() - inner.center()).norm(), 2);
  }
}

TEST(OrbitCamera, BehindTheRobotItLooksWhereTheRobotDrives) {
  const Pose3 robot = poseFromYpr(2, 1, 0, 0.8, 0, 0);
  const OrbitCamera view = behindRobot(robot, 800, 600);
  const auto here = view.project(robot.translation()), ahead = view.project(robot * Eigen::Vector3d(3, 0, 0)),
             left = view.project(robot * Eigen::Vector3d(1, 1, 0));
  ASSERT_TRUE(here && ahead && left);
  EXPECT_GT(here->y(), ahead->y()) << "the robot is nearer";
  EXPECT_NEAR(here->x(), ahead->x(), 1e-6);
  EXPECT_LT(left->x(), here->x());
}

}  // namespace
}  // namespace roomgraph::test
