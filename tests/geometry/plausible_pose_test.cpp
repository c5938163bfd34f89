// SPDX-License-Identifier: BSD-3-Clause
// Poses that can be, and the ways in which one cannot.
#include "roomgraph/geometry/plausible_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace roomgraph {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

// Turned by products of elementary rotations, which are orthonormal in closed form.
Pose3 turned(double yaw, double pitch, double x) {
  Pose3 pose = Pose3::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  pose.translation().x() = x;
  return pose;
}

TEST(PlausiblePose, RotationsAtAnyPlaceOfABuildingAreOnes) {
  for (const double yaw : {-3.1, 0.0, 0.7, 9.0})
    for (const double pitch : {-1.5, 0.0, 1.57})
      for (const double x : {-999e3, 0.0, 42.0}) EXPECT_EQ(problemOf(turned(yaw, pitch, x)), "");
}

TEST(PlausiblePose, EveryElementMustBeFinite) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      for (const double value : {kNaN, kInfinity, -kInfinity}) {
        Pose3 pose = turned(0.4, 0.1, 1);
        pose.matrix()(row, column) = value;
        EXPECT_EQ(problemOf(pose), "pose is not finite") << row << ", " << column;
      }
}

TEST(PlausiblePose, FarAwayIsNone) {
  EXPECT_EQ(problemOf(turned(0, 0, 1.001e6)), "pose is more than 1000 km away");
  EXPECT_EQ(problemOf(turned(0, 0, -1e300)), "pose is more than 1000 km away");
}

TEST(PlausiblePose, ScaledShearedAndMirroredAreNoRotations) {
  Pose3 scaled = turned(0.3, 0.2, 0), sheared = scaled, mirrored = scaled, zero = scaled;
  scaled.linear() *= 1.001;
  sheared.linear()(0, 1) += 0.01;
  mirrored.linear().col(2) *= -1;  // orthonormal, with determinant -1
  zero.linear().setZero();
  for (const Pose3& pose : {scaled, sheared, mirrored, zero})
    EXPECT_EQ(problemOf(pose), "pose's rotation is none");
  EXPECT_EQ(problemOf(scaled, 0.01), "") << "within the rounding that is allowed";
  EXPECT_EQ(problemOf(mirrored, 0.01), "pose's rotation is none");
}

TEST(PlausiblePose, InThePlane) {
  EXPECT_EQ(problemOf(Pose2{3, -4, 100}), "");
  EXPECT_EQ(problemOf(Pose2{kNaN, 0, 0}), "pose is not finite");
  EXPECT_EQ(problemOf(Pose2{0, kInfinity, 0}), "pose is not finite");
  EXPECT_EQ(problemOf(Pose2{0, 0, kNaN}), "pose is not finite");
  EXPECT_EQ(problemOf(Pose2{0.8e6, 0.5e6, 0}), "") << "943 km";
  EXPECT_EQ(problemOf(Pose2{0.8e6, -0.8e6, 0}), "pose is more than 1000 km away")
      << "1131 km, either coordinate less";
  EXPECT_EQ(problemOf(Pose2{0, 0, 1e7}), "pose's angle is too large");
  EXPECT_EQ(problemOf(Pose2{0, 0, -1e7}), "pose's angle is too large");
}

}  // namespace
}  // namespace roomgraph
