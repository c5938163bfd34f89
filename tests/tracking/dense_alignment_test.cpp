// SPDX-License-Identifier: BSD-3-Clause
// Dense alignment: rendered movements, a bare wall, people left out, images that do not meet.
#include "dense_alignment.h"

#include <gtest/gtest.h>

#include "textured_room.h"

namespace roomgraph::tracking {
namespace {

using test::TexturedRoom;

double angleBetween(const Pose3& a, const Pose3& b) {
  return rotationAngle(a.inverse() * b);
}

TEST(DenseAlignment, FindsMovementsOfARoom) {
  const TexturedRoom room;
  // Into a corner of the room, and down.
  const Pose3 first = poseFromYpr(1.2, 0.1, 0.2, 0, 0.9, -0.5);
  const DenseImage reference(room.render(0, first), {});
  for (const Pose3& moved :
       {poseFromYpr(0.05, -0.02, 0.08, 0.02, 0.03, -0.02), poseFromYpr(-0.1, 0, 0.05, 0, 0.1, 0), Pose3(Pose3::Identity())}) {
    const DenseImage current(room.render(1, first * moved), {});
    const auto found = alignDense(reference, current, {});
    ASSERT_TRUE(found);
    EXPECT_LT((found->reference_from_current.translation() - moved.translation()).norm(), 0.006);
    EXPECT_LT(angleBetween(found->reference_from_current, moved), 0.003);
    EXPECT_GT(found->overlap, 0.7);
    EXPECT_LT((found->covariance.topLeftCorner<3, 3>().trace()), 3 * 0.01 * 0.01) << "corners and textures say all";
  }
}

// A wall straight ahead at 2 m, without a texture but for the camera's noise, and darker towards the image's border as lenses
// make it: along it and about its normal nothing is seen.
Frame bareWall(double t, const Pose3& world_from_camera) {
  Frame frame;
  frame.t = t;
  frame.camera = TexturedRoom::camera();
  frame.gray.create(frame.camera.height, frame.camera.width, CV_8UC1);
  cv::RNG random(static_cast<std::uint64_t>(1 + t));
  cv::Mat noise(frame.gray.size(), CV_32FC1);
  random.fill(noise, cv::RNG::NORMAL, 0, 4);
  for (int v = 0; v < frame.gray.rows; ++v)
    for (int u = 0; u < frame.gray.cols; ++u) {
      const Eigen::Vector3d ray = frame.camera.ray(u, v);
      frame.gray.at<uchar>(v, u) = cv::saturate_cast<uchar>(160 / (1 + 0.5 * ray.head<2>().squaredNorm()) + noise.at<float>(v, u));
    }
  frame.depth.create(frame.gray.size(), CV_32FC1);
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) {
      const Eigen::Vector3d ray = world_from_camera.linear() * frame.camera.ray(u, v);
      frame.depth.at<float>(v, u) = static_cast<float>((2 - world_from_camera.translation().z()) / ray.z());
    }
  return frame;
}

TEST(DenseAlignment, AlongABareWallThePriorIsWhatIsKnown) {
  const DenseImage reference(bareWall(0, Pose3::Identity()), {});
  const DenseImage current(bareWall(1, poseFromYpr(0.1, 0, 0.06, 0, 0.04, 0)), {});
  const DensePrior prior{poseFromYpr(0.07, 0.01, 0, 0, 0, 0), sameInAllDirections(0.02, 0.03), sameInAllDirections(0.1, 0.2)};
  const auto found = alignDense(reference, current, prior);
  ASSERT_TRUE(found);
  const Eigen::Vector3d place = found->reference_from_current.translation();
  EXPECT_NEAR(place.z(), 0.06, 0.003) << "towards the wall";
  EXPECT_NEAR(angleBetween(found->reference_from_current, poseFromYpr(0, 0, 0, 0, 0.04, 0)), 0, 0.005);
  EXPECT_NEAR(place.x(), 0.07, 0.02) << "along it, as predicted";
  EXPECT_NEAR(std::sqrt(found->covariance(0, 0)), 0.1, 0.02);
  EXPECT_NEAR(std::sqrt(found->covariance(5, 5)), 0.2, 0.02) << "about its normal";
  EXPECT_LT(std::sqrt(found->covariance(2, 2)), 0.01);
}

// Small changes in b's axes are those in a's.
TEST(Adjoint, IsThatOfTheGroup) {
  const Pose3 a_from_b = poseFromYpr(0.3, -1, 2, 0.7, -0.4, 1.1);
  for (int i = 0; i < 6; ++i) {
    const auto moved = [](const Vector6d& small) {
      Pose3 out = Pose3::Identity();
      out.linear() = expSO3(small.tail<3>());
      out.translation() = small.head<3>();
      return out;
    };
    const Vector6d in_b = 1e-6 * Vector6d::Unit(i), in_a = adjoint(a_from_b) * in_b;
    EXPECT_LT(((a_from_b * moved(in_b)).matrix() - (moved(in_a) * a_from_b).matrix()).norm(), 1e-11) << i;
  }
}

// A robot that looks ahead at a wall moves sideways, upwards and tilts less than a hand.
TEST(DenseAlignment, AlongABareWallARobotStaysOnItsWay) {
  const DenseImage reference(bareWall(0, Pose3::Identity()), {});
  const DenseImage current(bareWall(1, poseFromYpr(0, 0, 0.06, 0, 0, 0)), {});
  DensePrior prior{.reference_from_current = poseFromYpr(0.03, 0.02, 0.05, 0, 0, 0)};
  Pose3 camera_from_robot = Pose3::Identity();
  camera_from_robot.linear() = bodyFromOptical().transpose();
  prior.current_from_body = camera_from_robot;
  prior.sigma << 0.05, 0.002, 0.02, 0.01, 0.01, 0.05;
  prior.unseen << 0.2, 0.004, 0.05, 0.02, 0.03, 0.2;
  const auto found = alignDense(reference, current, prior);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reference_from_current.translation().z(), 0.06, 0.003) << "seen";
  EXPECT_NEAR(found->reference_from_current.translation().x(), 0.03, 0.002) << "sideways as predicted";
  EXPECT_NEAR(std::sqrt(found->covariance(0, 0)), 0.004, 0.001) << "sideways is the camera's x";
  EXPECT_NEAR(std::sqrt(found->covariance(1, 1)), 0.05, 0.01) << "upwards its y";
  EXPECT_NEAR(std::sqrt(found->covariance(5, 5)), 0.02, 0.005) << "roll is about its z, and not seen";
}

// What was found far from where the velocity leads is a likeness.
TEST(DenseAlignment, AnImplausibleStepIsNone) {
  const TexturedRoom room;
  const Pose3 first = poseFromYpr(1.2, 0.1, 0.2, 0, 0.9, -0.5), moved = poseFromYpr(0.1, 0, 0, 0, 0, 0);
  const DenseImage reference(room.render(0, first), {}), current(room.render(1, first * moved), {});
  EXPECT_TRUE(alignDense(reference, current, {.sigma = sameInAllDirections(0.03, 0.03), .plausible_m = 0.12}));
  EXPECT_FALSE(alignDense(reference, current, {.sigma = sameInAllDirections(0.03, 0.03), .plausible_m = 0.08}));
}

// A plane that leans away: each normal against the plane's own, and how far noise turns it.
TEST(DenseImage, NormalsArePlanesOfTheirNeighbours) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1).normalized();
  Frame frame = bareWall(0, Pose3::Identity());
  const auto depthOf = [&](int u, int v) { return -2 / normal.dot(frame.camera.ray(u, v)); };
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) frame.depth.at<float>(v, u) = static_cast<float>(depthOf(u, v));
  const DenseLevel exact = DenseImage(frame, {}).levels().front();
  for (int v = 5; v + 5 < exact.depth.rows; v += 7)
    for (int u = 5; u + 5 < exact.depth.cols; u += 7) {
      const cv::Vec3f n = exact.normals.at<cv::Vec3f>(v, u);
      ASSERT_LT((Eigen::Vector3d(n[0], n[1], n[2]) - normal).norm(), 0.005) << u << " " << v;
      EXPECT_LT(exact.normal_variance.at<float>(v, u), 1e-4);
    }
  EXPECT_EQ(exact.normals.at<cv::Vec3f>(0, 0), cv::Vec3f()) << "the square is not within the image";

  cv::RNG random(3);
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) frame.depth.at<float>(v, u) += static_cast<float>(random.gaussian(0.005));
  const DenseLevel noisy = DenseImage(frame, {}).levels().front();
  double scatter = 0, said = 0;
  int count = 0;
  for (int v = 5; v + 5 < noisy.depth.rows; ++v)
    for (int u = 5; u + 5 < noisy.depth.cols; ++u, ++count) {
      const cv::Vec3f n = noisy.normals.at<cv::Vec3f>(v, u);
      scatter += (Eigen::Vector3d(n[0], n[1], n[2]) - normal).squaredNorm() / 2;
      said += noisy.normal_variance.at<float>(v, u);
    }
  // Depth cameras err alike over some pixels, which is allowed for; this noise is independent.
  EXPECT_NEAR(said / scatter, 8, 2);
}

// A picture that has left the view says nothing of where it went.
TEST(DenseAlignment, AnEdgeThatOneImageShowsHoldsNothing) {
  Frame first = bareWall(0, Pose3::Identity());
  first.gray(cv::Rect(first.gray.cols - 24, 60, 20, 120)) = 20;
  const DenseImage reference(first, {}), current(bareWall(1, poseFromYpr(-0.03, 0, 0, 0, 0, 0)), {});
  const auto found = alignDense(reference, current, {poseFromYpr(-0.03, 0, 0, 0, 0, 0), sameInAllDirections(0.05, 0.05), sameInAllDirections(0.1, 0.2)});
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::sqrt(found->covariance(0, 0)), 0.1, 0.02);
  EXPECT_NEAR(std::sqrt(found->covariance(1, 1)), 0.1, 0.02);
  EXPECT_NEAR(std::sqrt(found->covariance(5, 5)), 0.2, 0.02);
}

// Normals scatter about the wall's, which must not look as if it held along the wall.
TEST(DenseAlignment, NoiseOfDepthsHoldsNothingAlongAWall) {
  cv::RNG random(5);
  const auto noisy = [&random](Frame frame) {
    for (int v = 0; v < frame.depth.rows; ++v)
      for (int u = 0; u < frame.depth.cols; ++u) frame.depth.at<float>(v, u) += static_cast<float>(random.gaussian(0.004));
    return frame;
  };
  const DenseImage reference(noisy(bareWall(0, Pose3::Identity())), {});
  const DenseImage current(noisy(bareWall(1, poseFromYpr(0.04, 0, 0, 0, 0, 0))), {});
  const auto found = alignDense(reference, current, {poseFromYpr(0.05, 0.01, 0, 0, 0, 0), sameInAllDirections(0.05, 0.05), sameInAllDirections(0.1, 0.2)});
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::sqrt(found->covariance(0, 0)), 0.1, 0.02);
  EXPECT_NEAR(std::sqrt(found->covariance(5, 5)), 0.2, 0.04);
  EXPECT_LT(std::sqrt(found->covariance(2, 2)), 0.01);
}

TEST(DenseAlignment, WhatIsLeftOutDoesNotCount) {
  const TexturedRoom room;
  Frame first = room.render(0, Pose3::Identity()), second = room.render(1, poseFromYpr(0.04, 0, 0, 0, 0, 0));
  // Somebody near who goes the other way.
  for (const auto& [frame, at] : {std::pair{&first, 80}, {&second, 110}}) {
    frame->depth(cv::Rect(at, 40, 110, 180)) = 1.0f;
    frame->gray(cv::Rect(at, 40, 110, 180)) = 30;
  }
  const DenseImage reference(first, {Box2{75, 35, 195, 225}}), current(second, {Box2{105, 35, 225, 225}});
  const auto found = alignDense(reference, current, {});
  ASSERT_TRUE(found);
  EXPECT_LT((found->reference_from_current.translation() - Eigen::Vector3d(0.04, 0, 0)).norm(), 0.006);
}

TEST(DenseAlignment, NothingWhereImagesDoNotMeet) {
  const TexturedRoom room, elsewhere(77);
  const DenseImage reference(room.render(0, Pose3::Identity()), {});
  EXPECT_FALSE(alignDense(reference, DenseImage(elsewhere.render(1, Pose3::Identity()), {}), {})) << "the same walls";
  Frame without = room.render(1, Pose3::Identity());
  without.depth.setTo(0);
  EXPECT_FALSE(alignDense(reference, DenseImage(without, {}), {}));
  const DenseImage behind(room.render(1, poseFromYpr(0, 0, 0, 0, M_PI, 0)), {});
  EXPECT_FALSE(alignDense(reference, behind, {poseFromYpr(0, 0, 0, 0, M_PI, 0)}));
}

}  // namespace
}  // namespace roomgraph::tracking
