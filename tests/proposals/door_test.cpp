// SPDX-License-Identifier: BSD-3-Clause
// Vertical planes, intervals and doors against sampling and rendered scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "door_from_image.h"
#include "door_generator.h"
#include "door_on_plane.h"
#include "plane_fit.h"
#include "proposal_covariance.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

BoxEvidence doorEvidence(const Scene& scene, bool with_depth) {
  cv::Mat labels;
  Frame frame = scene.render(&labels);
  frame.gray = test::shaded(frame, labels);
  const Detection detection = test::detectionOf(1, labels, "door");
  if (!with_depth) frame.depth = cv::Mat();
  return gatherEvidence(frame, detection, *database().find("door"), groundInCamera(scene.world_from_camera));
}

double lineAngle(double a, double b) {
  return std::abs(wrapAngle(2 * (a - b))) / 2;
}

// A wall through (d, 0) in direction of its normal, turned by `turn`; points with errors along the view.
std::vector<Eigen::Vector2d> wallPoints(double distance, double turn, double from, double to, int count,
                                        std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> place(from, to);
  const Eigen::Vector2d normal(std::cos(turn), std::sin(turn)), along(-normal.y(), normal.x());
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p = distance * normal + place(random) * along;
    points.push_back(p * (1 + depthSigma(p.norm()) * gauss(random) / p.norm()));
  }
  return points;
}

TEST(VerticalPlane, FoundWithinItsDeviationsFacingAndGlancing) {
  std::mt19937 random(3);
  for (int run = 0; run < 40; ++run) {
    const bool glancing = run % 2 == 0;
    const double turn = 0.07 * run;
    auto points =
        glancing ? wallPoints(1, turn, 3, 4, 300, random) : wallPoints(3, turn, -0.5, 0.5, 300, random);
    std::uniform_real_distribution<double> anywhere(0.5, 4);
    for (int i = 0; i < 100; ++i) points.emplace_back(anywhere(random), anywhere(random));
    const auto plane = fitVerticalPlane(points);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->normal.norm(), 1, 1e-12);
    EXPECT_LE(plane->offset, 0);  // the normal points to the camera
    EXPECT_LT(lineAngle(std::atan2(plane->normal.y(), plane->normal.x()), turn), 3 * plane->sigma_rad);
    const Eigen::Vector2d normal(std::cos(turn), std::sin(turn));
    const Eigen::Vector2d middle = plane->normal * plane->offset + plane->along() * plane->middle;
    EXPECT_NEAR(normal.dot(middle), glancing ? 1 : 3, 3 * plane->sigma_m);
    EXPECT_LT(plane->sigma_rad, 0.05);
    EXPECT_GT(plane->inlier_share, 0.7);
  }
}

TEST(VerticalPlane, NoneInScatteredPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(4 + anywhere(random), anywhere(random));
  EXPECT_FALSE(fitVerticalPlane(points));
  points.resize(20);
  EXPECT_FALSE(fitVerticalPlane(points));
}

double intervalCost(const SeenInterval& s, double usual, double sigma, double center, double width) {
  const double low = center - width / 2 - s.low, high = center + width / 2 - s.high;
  const bool low_counts = !s.low_cut || low > 0, high_counts = !s.high_cut || high < 0;
  return std::pow((width - usual) / sigma, 2) + low_counts * std::pow(low / s.low_sigma, 2) +
         high_counts * std::pow(high / s.high_sigma, 2);
}

TEST(Interval, LeastSquaresEqualsBruteForce) {
  const double usual = 0.9, sigma = 0.1;
  const SeenInterval cases[] = {{1.0, 1.7, 0.05, 0.2, false, false}, {-0.4, 0.8, 0.3, 0.02, false, false},
                                {1.0, 1.5, 0.05, 0.05, true, false}, {1.0, 1.5, 0.05, 0.05, false, true},
                                {1.0, 2.3, 0.05, 0.05, false, true}, {1.0, 2.3, 0.05, 0.05, true, false}};
  for (const auto& seen : cases) {
    double least = std::numeric_limits<double>::infinity(), center = 0, width = 0;
    for (double c = -1; c < 3; c += 0.002)
      for (double w = 0.4; w < 1.6; w += 0.002)
        if (const double cost = intervalCost(seen, usual, sigma, c, w); cost < least)
          least = cost, center = c, width = w;
    const Interval found = fitInterval(seen, usual, sigma);
    EXPECT_NEAR(found.center, center, 0.004);
    EXPECT_NEAR(found.width, width, 0.004);
  }
}

TEST(Interval, DeviationOfTheCentreEqualsSampling) {
  std::mt19937 random(8);
  std::normal_distribution<double> gauss;
  const double low_sigma = 0.05, high_sigma = 0.25, width_sigma = 0.1;
  double squares = 0, claimed = 0;
  constexpr int kRuns = 20000;
  for (int i = 0; i < kRuns; ++i) {
    const double width = 0.9 + width_sigma * gauss(random);
    const SeenInterval seen{2 - width / 2 + low_sigma * gauss(random),
                            2 + width / 2 + high_sigma * gauss(random),
                            low_sigma,
                            high_sigma,
                            false,
                            false};
    const Interval found = fitInterval(seen, 0.9, width_sigma);
    squares += std::pow(found.center - 2, 2);
    claimed = found.center_sigma;
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns), claimed, 0.03 * claimed);
}

// Both ends give the width as their difference, whose variance is the sum; one end alone does not.
TEST(Interval, WidthInformationIsThatOfTheEndsAlone) {
  const Interval both = fitInterval({1.0, 1.7, 0.05, 0.2, false, false}, 0.9, 0.1);
  EXPECT_NEAR(both.width_information, 1 / (0.05 * 0.05 + 0.2 * 0.2), 1e-9);
  EXPECT_NEAR(fitInterval({1.0, 1.7, 0.05, 0.2, false, true}, 0.9, 0.1).width_information, 0, 1e-9);
}

TEST(Interval, VagueWhenNoEndIsSeen) {
  const Interval found = fitInterval({0.2, 0.6, 0.05, 0.05, true, true}, 0.9, 0.1);
  EXPECT_NEAR(found.width, 0.9, 1e-9);
  EXPECT_GT(found.center_sigma, 1);
}

// A glancing view knows the wall, not where on it the door is.
TEST(DoorOnPlane, GlancingViewIsVagueAlongTheWallOnly) {
  Scene scene;
  scene.lookAhead(1.2, 0);
  scene.addBox(3.2, 1.03, -std::numbers::pi / 2, 0.9, 0.12, 0, 2.05, 1);
  scene.addBox(3.2, 1.03, -std::numbers::pi / 2, 8, 0.1, 0, 2.6, 2);  // its wall
  const auto found = test::hypotheses<DoorGenerator>(doorEvidence(scene, true));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(lineAngle(found[0].yaw, std::numbers::pi / 2), 0.02);
  EXPECT_NEAR(found[0].y, 1.03, 0.04);
  EXPECT_NEAR(found[0].x, 3.2, 0.2);
  ASSERT_TRUE(found[0].covariance);
  const Eigen::Matrix3d& c = *found[0].covariance;
  EXPECT_GT(c(0, 0), 4 * c(1, 1));
  EXPECT_LT(std::sqrt(c(2, 2)), 0.03);
  EXPECT_LT(std::pow(found[0].x - 3.2, 2), 9 * c(0, 0));
  EXPECT_LT(std::pow(found[0].y - 1.03, 2), 9 * c(1, 1));
}

// The upper side of a box is the door's top, and its left and right side are the jambs, only where the camera stands upright.
TEST(DoorOnPlane, WhateverTheRollOfTheCamera) {
  for (const double roll : {0.0, std::numbers::pi / 2, -std::numbers::pi / 2, std::numbers::pi})
    for (const double turn : {0.0, 0.5, -0.5}) {
      Scene scene;
      scene.lookAhead(1.1, 0.05, roll);
      scene.addBox(3.4, 0.3, std::numbers::pi + turn, 0.9, 0.12, 0, 2.05, 1);
      scene.addBox(3.4, 0.3, std::numbers::pi + turn, 8, 0.1, 0, 2.6, 2);  // its wall
      const auto found = test::hypotheses<DoorGenerator>(doorEvidence(scene, true));
      ASSERT_FALSE(found.empty()) << roll << ' ' << turn;
      EXPECT_NEAR(found[0].shape.height, 2.05, 0.05) << roll << ' ' << turn;
      EXPECT_NEAR(found[0].shape.width, 0.9, 0.08) << roll << ' ' << turn;
      EXPECT_NEAR((Eigen::Vector2d(found[0].x, found[0].y) - Eigen::Vector2d(3.4, 0.3)).norm(), 0, 0.08) << roll << ' ' << turn;
    }
}

// A door in a wall straight ahead: what the box's sides are worth along the wall, by sampling them.
TEST(DoorOnPlane, DeviationAlongTheWallEqualsSampling) {
  std::mt19937 random(9);
  std::normal_distribution<double> gauss;
  BoxEvidence e;
  e.model = database().find("door");
  e.camera = {640, 480, 525, 525, 319.5, 239.5, {}};
  e.ground = {{0, -1, 0}, 1};
  e.camera_from_ground = cameraFromGround(e.ground);
  VerticalPlane wall = planeThrough({5, -1}, {5, 1});
  wall.sigma_m = 0.001;
  wall.inlier_share = 1;
  const double half = 525 * 0.45 / 5, px = sideSigma(2 * half);
  double squares = 0, claimed = 0;
  constexpr int kRuns = 4000;
  for (int i = 0; i < kRuns; ++i) {
    e.box = {319.5 - half + px * gauss(random), 100, 319.5 + half + px * gauss(random), 345};
    const auto placed = doorOnPlane(wall, e, e.model->depth_m / 4);
    ASSERT_TRUE(placed && placed->covariance);
    squares += placed->y * placed->y / kRuns;
    claimed += (*placed->covariance)(1, 1) / kRuns;
  }
  EXPECT_NEAR(claimed, squares, 0.1 * squares);
}

TEST(DoorOnPlane, CovarianceOfAConstructionIsKeptAndGrowsWithMisfit) {
  BoxEvidence evidence;
  evidence.model = database().find("door");
  PlacedShape placed;
  placed.covariance = Eigen::Vector3d(0.04, 0.0009, 0.0004).asDiagonal();
  placed.quality = 1;
  placed.has_yaw = true;
  const Eigen::Matrix4d good = covarianceOf(placed, evidence, 0.01);
  EXPECT_NEAR(good(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(good(1, 1), 0.0009, 1e-12);
  EXPECT_NEAR(good(3, 3), 0.0004, 1e-12);
  EXPECT_GT(good(2, 2), 0);
  placed.quality = 0.4;
  const Eigen::Matrix4d poor = covarianceOf(placed, evidence, 0.01);
  EXPECT_GT(poor(1, 1), 2 * good(1, 1));
  EXPECT_NEAR(poor(3, 3), good(3, 3), 1e-12);  // the plane's direction does not depend on the box
  placed.has_yaw = false;
  EXPECT_NEAR(covarianceOf(placed, evidence, 0.01)(3, 3), M_PI * M_PI, 1e-12);
}

TEST(DoorFromImage, RangeOfASideFromFloorAndTop) {
  for (const double range : {2.5, 4.0, 7.0}) {
    BoxEvidence e;
    e.model = database().find("door");
    e.camera = {640, 480, 525, 525, 319.5, 239.5, {}};
    const Pose3 world_from_camera = [] {
      Scene scene;
      scene.lookAhead(1.1, 0.05);
      return scene.world_from_camera;
    }();
    e.ground = groundInCamera(world_from_camera);
    e.camera_from_ground = cameraFromGround(e.ground);
    const Eigen::Vector3d foot(range * std::cos(0.3), range * std::sin(0.3), 0);
    const Eigen::Vector2d bottom = e.camera.project(world_from_camera.inverse() * foot);
    const Eigen::Vector2d top =
        e.camera.project(world_from_camera.inverse() * (foot + Eigen::Vector3d(0, 0, e.model->height_m)));
    e.box = {bottom.x(), top.y(), bottom.x() + 40, bottom.y()};
    const auto both = sideRange(e, bottom.x());
    ASSERT_TRUE(both);
    // The top's column differs a little from the bottom's: the camera looks down.
    EXPECT_NEAR(both->value, range, 0.02 * range);
    e.cut.top = true;
    const auto floor_only = sideRange(e, bottom.x());
    ASSERT_TRUE(floor_only);
    EXPECT_NEAR(floor_only->value, range, 1e-6);
    EXPECT_GT(floor_only->sigma, both->sigma);
    // Its error by finite differences: the box's bottom moved by its own deviation.
    BoxEvidence moved = e;
    moved.box.v_max -= 4 + 0.03 * e.box.height();
    EXPECT_NEAR(sideRange(moved, bottom.x())->value - range, floor_only->sigma, 0.5 * floor_only->sigma);
    e.cut.bottom = true;
    EXPECT_FALSE(sideRange(e, bottom.x()));
  }
}

TEST(DoorFromImage, LevelLinesGiveTheirDirection) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> angle(-1.4, 1.4), height(0, 2.1), side(-0.8, 0.8);
  Scene scene;
  scene.lookAhead(1.1, 0.1, 0.05);
  BoxEvidence e;
  e.camera = scene.camera;
  e.ground = groundInCamera(scene.world_from_camera);
  e.camera_from_ground = cameraFromGround(e.ground);
  const Pose3 ground_from_world = e.camera_from_ground.inverse() * scene.world_from_camera.inverse();
  int known = 0;
  for (int run = 0; run < 200; ++run) {
    const double direction = std::numbers::pi / 2 + angle(random), z = height(random);
    const Eigen::Vector3d middle(3.5, side(random), z);
    const Eigen::Vector3d along = 0.45 * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0);
    const Pose3 camera_from_world = scene.world_from_camera.inverse();
    const Segment2 segment{e.camera.project(camera_from_world * (middle - along)),
                           e.camera.project(camera_from_world * (middle + along))};
    const auto found = levelDirection(segment, e, 1);
    if (std::abs(z - 1.1) < 0.02) {
      EXPECT_FALSE(found);
    }
    if (!found) continue;
    ++known;
    const Eigen::Vector3d in_ground = ground_from_world.linear() * along;
    EXPECT_LT(lineAngle(found->value, std::atan2(in_ground.y(), in_ground.x())), 1e-6);
    // Moved by the error of its ends, across itself, the direction changes by about what is claimed.
    Segment2 turned = segment;
    const Eigen::Vector2d d = (segment.b - segment.a).normalized();
    turned.b += Eigen::Vector2d(-d.y(), d.x());
    const auto other = levelDirection(turned, e, 1);
    if (!other) continue;
    EXPECT_LT(lineAngle(other->value, found->value), 2 * found->sigma);
  }
  EXPECT_GT(known, 80);
  EXPECT_FALSE(levelDirection({{100, 40}, {102, 200}}, e, 1));  // steep
}

TEST(DoorFromImage, GlancingDoorInItsWall) {
  Scene scene;
  scene.lookAhead(1.2, 0.05);
  scene.max_range = 12;
  scene.addBox(4.0, 1.03, -std::numbers::pi / 2, 0.9, 0.06, 0, 2.05, 1);
  scene.addBox(4.0, 1.10, -std::numbers::pi / 2, 12, 0.1, 0, 2.6, 2);
  const auto found = test::hypotheses<DoorGenerator>(doorEvidence(scene, false));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(std::hypot(found[0].x - 4.0, found[0].y - 1.03), 0.35);
  double angle = 1e9;
  for (const auto& placed : found) angle = std::min(angle, lineAngle(placed.yaw, std::numbers::pi / 2));
  EXPECT_LT(angle, 0.1);
}

}  // namespace
}  // namespace roomgraph
