// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics to MRPT's camera and back.
#include "roomgraph/observations/mrpt_camera.h"

#include <gtest/gtest.h>

namespace roomgraph::test {
namespace {

TEST(MrptCamera, HasTheSameMatrixSizeAndDistortion) {
  const PinholeCamera camera{640, 480, 525, 526, 319.5, 239.25, {0.1, -0.2, 0.003, -0.004, 0.05}};
  const auto mrpt = toMrpt(camera);
  EXPECT_EQ(mrpt.ncols, 640u);
  EXPECT_EQ(mrpt.nrows, 480u);
  EXPECT_EQ(mrpt.intrinsicParams(0, 0), 525);
  EXPECT_EQ(mrpt.intrinsicParams(1, 1), 526);
  EXPECT_EQ(mrpt.intrinsicParams(0, 2), 319.5);
  EXPECT_EQ(mrpt.intrinsicParams(1, 2), 239.25);
  EXPECT_EQ(mrpt.distortion, mrpt::img::DistortionModel::plumb_bob);
  EXPECT_EQ(mrpt.dist[0], 0.1);  // k1 k2 t1 t2 k3
  EXPECT_EQ(mrpt.dist[2], 0.003);
  EXPECT_EQ(mrpt.dist[4], 0.05);
  const PinholeCamera back = toPinhole(mrpt);
  EXPECT_EQ(back.width, camera.width);
  EXPECT_EQ(back.height, camera.height);
  EXPECT_EQ(back.fx, camera.fx);
  EXPECT_EQ(back.fy, camera.fy);
  EXPECT_EQ(back.cx, camera.cx);
  EXPECT_EQ(back.cy, camera.cy);
  EXPECT_EQ(back.distortion, camera.distortion);
}

TEST(MrptCamera, WithoutDistortionHasNoModelOfIt) {
  EXPECT_EQ(toMrpt({640, 480, 525, 525, 320, 240, {}}).distortion, mrpt::img::DistortionModel::none);
}

// MRPT keeps all coefficients in one array: k1 k2 p1 p2 k3 k4 k5 k6, of a fisheye lens k1 k2 - - k3 k4.
TEST(MrptCamera, TellsTheModelOfItsDistortion) {
  mrpt::img::TCamera camera;
  EXPECT_EQ(distortionOf(camera), (Distortion{"plumb_bob", {0, 0, 0, 0, 0}}));
  camera.dist = {0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0};
  EXPECT_EQ(distortionOf(camera), (Distortion{"plumb_bob", {0.1, 0.2, 0.3, 0.4, 0.5}}));
  EXPECT_EQ(distortionOf(toPinhole(camera)), distortionOf(camera));
  for (const std::size_t one : {5, 6, 7}) {
    camera.dist = {0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0};
    camera.dist[one] = 0.6;
    EXPECT_EQ(distortionOf(camera), (Distortion{"rational_polynomial", {camera.dist.begin(), camera.dist.end()}}));
  }
  camera.setDistortionKannalaBrandt(0.1, 0.2, 0.3, 0.4);
  EXPECT_EQ(distortionOf(camera), (Distortion{"equidistant", {0.1, 0.2, 0.3, 0.4}}));
}

}  // namespace
}  // namespace roomgraph::test
