// SPDX-License-Identifier: BSD-3-Clause
// Ground plane on rendered scenes: furniture, tilt, failures, covariance by Monte Carlo.
#include "ground_plane.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <opencv2/core.hpp>
#include <random>

#include "scene.h"

namespace roomgraph {
namespace {

using test::Scene;
using ::testing::HasSubstr;

void expectNear(const Plane& plane, const Plane& truth, double angle, double height) {
  EXPECT_LT(std::acos(std::min(1.0, plane.normal.dot(truth.normal))), angle);
  EXPECT_NEAR(plane.offset, truth.offset, height);
}

TEST(GroundPlane, FloorWithFurnitureNearTheExpectedOne) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addBox(2.2, 0.3, 0.4, 1.6, 0.8, 0, 0.75, 1);
  const Plane truth = groundInCamera(scene.world_from_camera);
  Plane expected = truth;
  expected.normal = (expSO3({0.03, 0, 0.03}) * expected.normal).eval();
  expected.offset += 0.05;
  const auto found = findGround(scene.render(), expected);
  ASSERT_TRUE(found) << found.reason();
  EXPECT_TRUE(found->from_depth);
  expectNear(found->plane, truth, 0.004, 0.006);
}

TEST(GroundPlane, DeskLargerThanTheFloorDoesNotWin) {
  Scene scene;
  scene.lookAhead(1.5, 0.5, 0.1);
  scene.addBox(2.0, 0.3, 0, 2.0, 1.4, 0, 0.75, 1);  // most of the picture
  cv::Mat labels;
  const Frame frame = scene.render(&labels);
  ASSERT_GT(cv::countNonZero(labels == 1), 1.3 * cv::countNonZero(labels == 0));
  const auto found = findGround(frame, std::nullopt);
  ASSERT_TRUE(found) << found.reason();
  expectNear(found->plane, groundInCamera(scene.world_from_camera), 0.004, 0.006);
}

TEST(GroundPlane, TiltedHandheldCamera) {
  for (const double roll : {-0.5, 0.0, 0.45})
    for (const double pitch : {0.25, 0.7}) {
      Scene scene;
      scene.lookAhead(1.4, pitch, roll);
      const auto found = findGround(scene.render(), std::nullopt);
      ASSERT_TRUE(found) << found.reason() << " roll " << roll << " pitch " << pitch;
      expectNear(found->plane, groundInCamera(scene.world_from_camera), 0.004, 0.006);
    }
}

TEST(GroundPlane, CovarianceCoversTheErrorOfNoisyDepth) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  const Plane truth = groundInCamera(scene.world_from_camera);
  std::mt19937 random(3);
  std::normal_distribution<float> noise;
  const Frame clean = scene.render();
  for (int run = 0; run < 5; ++run) {
    Frame frame = clean;
    frame.depth = clean.depth.clone();
    for (int v = 0; v < frame.depth.rows; ++v)
      for (int u = 0; u < frame.depth.cols; ++u)
        if (float& z = frame.depth.at<float>(v, u); z > 0)
          z += (0.0012f + 0.0019f * (z - 0.4f) * (z - 0.4f)) * noise(random);
    const auto found = findGround(frame, truth);
    ASSERT_TRUE(found);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(found->covariance);
    EXPECT_GT(eigen.eigenvalues()(0), -1e-12);
    EXPECT_LT(std::abs(found->plane.offset - truth.offset), 3 * std::sqrt(found->covariance(3, 3)));
    EXPECT_LT((found->plane.normal - truth.normal).norm(),
              3 * std::sqrt(found->covariance.topLeftCorner<3, 3>().trace()));
    EXPECT_LT(std::sqrt(found->covariance(3, 3)), 0.05);
  }
}

TEST(GroundPlane, FailuresHaveReasons) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  const Plane truth = groundInCamera(scene.world_from_camera);
  const Frame good = scene.render();
  Plane wrong = truth;
  wrong.offset += 0.4;
  EXPECT_FALSE(findGround(good, wrong));
  Frame none = good;
  none.depth = cv::Mat();
  EXPECT_THAT(findGround(none, truth).reason(), HasSubstr("no depth"));
  none.depth = cv::Mat::zeros(240, 320, CV_32FC1);
  EXPECT_THAT(findGround(none, truth).reason(), HasSubstr("too few"));
  none.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(findGround(none, std::nullopt));
}

// Expected or not, what is seen must be a floor: upright enough, far enough below, and wide enough to fix its tilt.
TEST(GroundPlane, WhatIsNoFloorIsRefused) {
  const auto seen = [](double height, double pitch, double roll) {
    Scene scene;
    scene.lookAhead(height, pitch, roll);
    return scene.render();
  };
  const Frame turned = seen(1.2, 0.5, 0.6);  // by 0.76 rad against the upward direction of the image
  EXPECT_FALSE(findGround(turned, std::nullopt, {.max_tilt_rad = 0.7}));
  EXPECT_TRUE(findGround(turned, std::nullopt, {.max_tilt_rad = 0.85}));
  const Frame low = seen(0.5, 0.3, 0);
  EXPECT_FALSE(findGround(low, std::nullopt, {.min_camera_height_m = 0.6})) << "it may be a table";
  EXPECT_TRUE(findGround(low, std::nullopt, {.min_camera_height_m = 0.4}));
  Scene strip;
  strip.floor = false;
  strip.lookAhead(0.8, 0.3);
  const Plane truth = groundInCamera(strip.world_from_camera);
  const auto reasonWith = [&](double width) {
    strip.solids.clear();
    strip.addBox(2.5, 0, 0, width, 4, -0.1, 0, 1);
    const auto found = findGround(strip.render(), truth, {.min_points = 20});
    return found ? "" : found.reason();
  };
  EXPECT_EQ(reasonWith(1), "");
  EXPECT_EQ(reasonWith(0.25), "the visible floor is too narrow");
}

TEST(GroundPlane, AWallIsNoFloor) {
  Scene scene;
  scene.floor = false;
  scene.lookAhead(1.2, 0.3);
  scene.addBox(2, 0, 0, 6, 0.2, -3, 4, 1);
  EXPECT_FALSE(findGround(scene.render(), std::nullopt));
  EXPECT_FALSE(findGround(scene.render(), groundInCamera(scene.world_from_camera)));
}

TEST(GroundPlane, SomeBrokenPixelsDoNotMatter) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  Frame frame = scene.render();
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u)
      if ((u + v) % 3 == 0)
        frame.depth.at<float>(v, u) = (u % 2) ? 0.f : std::numeric_limits<float>::quiet_NaN();
  const auto found = findGround(frame, std::nullopt, {.min_camera_height_m = 0.5});
  ASSERT_TRUE(found) << found.reason();
  expectNear(found->plane, groundInCamera(scene.world_from_camera), 0.004, 0.006);
}

TEST(GroundPlane, OfTwoFloorsTheLowerOneOrTheExpectedOne) {
  Scene scene;
  scene.lookAhead(1.2, 0.5);
  scene.addBox(2.6, 0, 0, 6, 2.4, 0, 0.2, 1);  // a platform over the farther part
  const Plane floor = groundInCamera(scene.world_from_camera);
  const Plane platform{floor.normal, floor.offset - 0.2};
  const Frame frame = scene.render();
  const auto free = findGround(frame, std::nullopt);
  ASSERT_TRUE(free) << free.reason();
  expectNear(free->plane, floor, 0.004, 0.006);
  const auto expected = findGround(frame, floor);
  ASSERT_TRUE(expected) << expected.reason();
  expectNear(expected->plane, floor, 0.004, 0.006);
  // Expecting the platform is contradicted by what lies below it.
  const auto wrong = findGround(frame, platform);
  EXPECT_FALSE(wrong) << "camera height " << wrong->plane.offset;
}

TEST(GroundPlane, OnlyFarFloorInView) {
  Scene scene;
  scene.lookAhead(0.8, 0.0);
  scene.addBox(1.2, 0, 0, 4, 0.1, 0, 0.35, 1);  // hides the nearer part
  const auto found = findGround(scene.render(), groundInCamera(scene.world_from_camera));
  ASSERT_TRUE(found) << found.reason();
  expectNear(found->plane, groundInCamera(scene.world_from_camera), 0.006, 0.02);
  scene.lookAhead(0.8, -0.6);  // looks up: no floor at all
  EXPECT_FALSE(findGround(scene.render(), groundInCamera(scene.world_from_camera)));
  EXPECT_FALSE(findGround(scene.render(), std::nullopt));
}

// With the errors of one camera's calibration drawn anew for every run, the normalised squared error of three degrees of
// freedom is chi-square distributed: the sum over the runs lies within 3 kRuns +- 3.3 sqrt(6 kRuns), but once in a
// thousand.
TEST(GroundPlane, CovarianceAgreesWithMonteCarlo) {
  Scene scene;
  scene.lookAhead(0.8, 0.3);
  const Plane truth = groundInCamera(scene.world_from_camera);
  const Frame clean = scene.render();
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d first = truth.normal.unitOrthogonal(), second = truth.normal.cross(first);
  double sum = 0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    Frame frame = clean;
    frame.depth = clean.depth.clone();
    // Calibration: the cloud is turned by 0.003 rad and moved by 5 mm; the depth of a pixel follows.
    const Plane turned{expSO3(0.003 * (normal(random) * first + normal(random) * second)) * truth.normal,
                       truth.offset + 0.005 * normal(random)};
    for (int v = 0; v < frame.depth.rows; ++v)
      for (int u = 0; u < frame.depth.cols; ++u)
        if (float& z = frame.depth.at<float>(v, u); z > 0) {
          const auto p = intersect(frame.camera.ray(u, v), turned);
          const double there = p ? p->z() : 0;
          z = there > 0 && there < 5
                  ? static_cast<float>(there + (0.0012 + 0.0019 * std::pow(there - 0.4, 2)) * normal(random))
                  : 0.f;
        }
    const auto found = findGround(frame, truth);
    ASSERT_TRUE(found) << found.reason();
    Eigen::Matrix<double, 3, 4> reduce = Eigen::Matrix<double, 3, 4>::Zero();
    reduce.block<1, 3>(0, 0) = first.transpose();
    reduce.block<1, 3>(1, 0) = second.transpose();
    reduce(2, 3) = 1;
    Eigen::Vector4d difference;
    difference << found->plane.normal - truth.normal, found->plane.offset - truth.offset;
    const Eigen::Vector3d e = reduce * difference;
    sum += e.dot((reduce * found->covariance * reduce.transpose()).ldlt().solve(e));
  }
  EXPECT_NEAR(sum, 3 * kRuns, 3.3 * std::sqrt(6 * kRuns));
}

}  // namespace
}  // namespace roomgraph
