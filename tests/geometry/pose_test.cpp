// SPDX-License-Identifier: BSD-3-Clause
// SO(3) maps against series, planar poses, interpolation.
#include "roomgraph/geometry/pose.h"

#include <gtest/gtest.h>

#include <numbers>

#include "random_poses.h"

namespace roomgraph {
namespace {

using std::numbers::pi;
using test::Random;

// exp of the matrix of the cross product, summed term by term.
Eigen::Matrix3d expBySeries(const Eigen::Vector3d& w) {
  Eigen::Matrix3d cross;
  cross << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = Eigen::Matrix3d::Identity();
  for (int n = 1; n < 60; ++n) {
    term = term * cross / n;
    sum += term;
  }
  return sum;
}

TEST(SO3, ExpInvertsLogUpToHalfATurn) {
  Random random(3);
  for (const double angle : {0.5, 3.1, pi - 1e-4, pi - 1e-7}) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
    EXPECT_TRUE(expSO3(logSO3(rotation)).isApprox(rotation, 1e-6)) << angle;
  }
}

TEST(SO3, ExpLogAndAngle) {
  Random random(4);
  for (const double angle : {0.0, 1e-14, 1e-7, 0.3, 2.0, 3.14}) {
    const Eigen::Vector3d vector = angle * random.direction();
    EXPECT_LT((logSO3(expSO3(vector)) - vector).norm(), 1e-7) << angle;
    EXPECT_TRUE(expSO3(vector).isApprox(expBySeries(vector), 1e-9)) << angle;
    Pose3 pose = Pose3::Identity();
    pose.linear() = expSO3(vector);
    EXPECT_NEAR(rotationAngle(pose), angle, 1e-7);
  }
}

TEST(WrapAngle, IntoHalfOpenInterval) {
  EXPECT_DOUBLE_EQ(wrapAngle(pi), pi);
  EXPECT_DOUBLE_EQ(wrapAngle(-pi), pi);
  EXPECT_DOUBLE_EQ(wrapAngle(0), 0);
  for (int turns = -3; turns <= 3; ++turns) {
    EXPECT_NEAR(wrapAngle(1 + 2 * pi * turns), 1, 1e-12);
    EXPECT_NEAR(wrapAngle(-3 + 2 * pi * turns), -3, 1e-12);
  }
  EXPECT_NEAR(wrapAngle(-1e-18), 0, 1e-15);
}

TEST(Pose2, AgreesWithPose3) {
  Random random(5);
  for (int round = 0; round < 50; ++round) {
    const auto planar = [&] {
      const double x = random.uniform(-5, 5), y = random.uniform(-5, 5);
      return Pose2{x, y, random.uniform(-3.1, 3.1)};
    };
    const Pose2 a = planar(), b = planar();
    EXPECT_TRUE(toPose3(a * b).isApprox(toPose3(a) * toPose3(b), 1e-12));
    EXPECT_TRUE(toPose3(a.inverse()).isApprox(toPose3(a).inverse(), 1e-12));
    const Eigen::Vector2d p(1, 2);
    EXPECT_TRUE((a * p).isApprox((toPose3(a) * Eigen::Vector3d(1, 2, 0)).head<2>(), 1e-12));
    const Pose2 back = planarPart(toPose3(a));
    EXPECT_NEAR(back.x, a.x, 1e-12);
    EXPECT_NEAR(back.y, a.y, 1e-12);
    EXPECT_NEAR(back.yaw, a.yaw, 1e-12);
  }
}

TEST(Pose3, YawPitchRollAndMrptRoundTrip) {
  Random random(6);
  // Quarter turns by hand: yaw sends x to y, pitch sends x to -z, roll sends y to z.
  EXPECT_TRUE(
      (poseFromYpr(0, 0, 0, pi / 2, 0, 0) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(
      (poseFromYpr(0, 0, 0, 0, pi / 2, 0) * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(
      (poseFromYpr(0, 0, 0, 0, 0, pi / 2) * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ()));
  for (int round = 0; round < 50; ++round) {
    const Pose3 pose = random.pose(5);
    EXPECT_TRUE(toPose3(toMrpt(pose)).isApprox(pose, 1e-9));
    const Eigen::Vector3d p = random.vector(2), moved = pose * p;
    double x = 0, y = 0, z = 0;
    toMrpt(pose).composePoint(p.x(), p.y(), p.z(), x, y, z);
    EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(x, y, z), 1e-9));
  }
  for (const double pitch : {pi / 2, -pi / 2}) {
    const Pose3 steep = poseFromYpr(1, 2, 3, 0.4, pitch, -0.2);
    EXPECT_TRUE(toPose3(toMrpt(steep)).isApprox(steep, 1e-6)) << "at the singularity of yaw and roll";
  }
}

TEST(Pose3, InterpolationRunsAlongTheGeodesic) {
  Random random(7);
  for (int round = 0; round < 20; ++round) {
    const Pose3 a = random.pose(3), b = random.pose(3);
    EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-9));
    EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-9));
    const Eigen::Vector3d turn = logSO3(a.linear().transpose() * b.linear());
    const Pose3 third = interpolate(a, b, 1.0 / 3);
    EXPECT_TRUE(third.linear().isApprox(a.linear() * expSO3(turn / 3), 1e-9));
    EXPECT_TRUE(third.translation().isApprox((2 * a.translation() + b.translation()) / 3, 1e-9));
  }
}

TEST(Pose3, NormalizedRestoresOrthonormality) {
  Pose3 pose = Random(8).pose(3);
  const Pose3 clean = pose;
  pose.linear() += 1e-6 * Eigen::Matrix3d::Random();
  const Pose3 fixed = normalized(pose);
  EXPECT_LT((fixed.linear() * fixed.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_TRUE(fixed.isApprox(clean, 1e-5));
}

TEST(Pose3, OpticalAxesInTheBody) {
  EXPECT_TRUE((bodyFromOptical() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX())) << "forward";
  EXPECT_TRUE((bodyFromOptical() * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitY())) << "right";
  EXPECT_TRUE((bodyFromOptical() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ())) << "down";
}

}  // namespace
}  // namespace roomgraph
