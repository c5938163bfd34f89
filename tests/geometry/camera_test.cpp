// SPDX-License-Identifier: BSD-3-Clause
// PinholeCamera: projection, validity and scaling.
#include "roomgraph/geometry/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace roomgraph {
namespace {

const PinholeCamera kCamera{640, 480, 525, 520, 319.5, 239.5, {}};

TEST(PinholeCamera, ProjectionAndBackProjection) {
  const Eigen::Vector3d p(0.4, -0.3, 2);
  const Eigen::Vector2d pixel = kCamera.project(p);
  EXPECT_DOUBLE_EQ(pixel.x(), 525 * 0.2 + 319.5);
  EXPECT_DOUBLE_EQ(pixel.y(), -520 * 0.15 + 239.5);
  EXPECT_TRUE(kCamera.backProject(pixel.x(), pixel.y(), 2).isApprox(p, 1e-12));
  const Eigen::Vector3d homogeneous = kCamera.matrix() * p;
  EXPECT_TRUE(homogeneous.hnormalized().isApprox(pixel, 1e-12));
}

TEST(PinholeCamera, Validity) {
  EXPECT_FALSE(PinholeCamera{}.valid());
  EXPECT_TRUE(kCamera.valid());
  EXPECT_TRUE(kCamera.sees(0, 0));
  EXPECT_FALSE(kCamera.sees(640, 0));
  EXPECT_FALSE(kCamera.sees(0, -0.1));
}

TEST(PinholeCamera, ScalingKeepsTheImagesCorners) {
  const PinholeCamera half = kCamera.scaled(0.5);
  EXPECT_EQ(half.width, 320);
  EXPECT_EQ(half.height, 240);
  for (const auto& corner : {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(639.5, 479.5)}) {
    const Eigen::Vector2d scaled = half.project(kCamera.ray(corner.x(), corner.y()));
    EXPECT_NEAR(scaled.x() + 0.5, (corner.x() + 0.5) / 2, 1e-9);
    EXPECT_NEAR(scaled.y() + 0.5, (corner.y() + 0.5) / 2, 1e-9);
  }
}

}  // namespace
}  // namespace roomgraph
