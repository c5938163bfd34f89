// SPDX-License-Identifier: BSD-3-Clause
// Off-screen renderer against the exact depth image; ambient occlusion in corners.
#include "color_renderer.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "example_world.h"
#include "id_raster.h"

namespace roomgraph {
namespace {

struct Rendered {
  explicit Rendered(const World& of = test::exampleWorld()) : world(of) {}

  World world;
  Scene scene{world};
  ColorRenderer renderer{scene, world.camera->model};
  std::vector<Pose3> parts = scene.partPoses(1);
  Pose3 pose = scene.worldFromCamera(1);
  IdImage exact = rasterize(scene, parts, pose, world.camera->model);
};

TEST(ColorRenderer, ItsDepthIsThatOfTheExactPicture) {
  Rendered r;
  const cv::Mat depth = r.renderer.renderDepth(r.parts, r.pose, 1);
  int compared = 0, different = 0;
  for (int v = 1; v < depth.rows - 1; ++v) {
    for (int u = 1; u < depth.cols - 1; ++u) {
      ++compared;
      const float exact = r.exact.depth.at<float>(v, u);
      different += std::abs(depth.at<float>(v, u) - exact) > 0.003f * exact + 0.002f;
    }
  }
  // Only pixels that lie across an edge differ.
  EXPECT_LT(different, compared / 100);
}

TEST(ColorRenderer, ColourAndDepthAreRegisteredWithinAPixel) {
  Rendered r;
  cv::Mat gray;
  cv::cvtColor(r.renderer.render(r.parts, r.pose, 1), gray, cv::COLOR_BGR2GRAY);
  // The black block before the white wall: in every row both edges are where the object's pixels end.
  int rows = 0;
  for (int v = 220; v < 300; v += 4) {
    int first = -1, last = -1;
    for (int u = 0; u < gray.cols; ++u) {
      if (r.exact.object.at<short>(v, u) != 0) continue;
      if (first < 0) first = u;
      last = u;
    }
    if (first < 2) continue;
    ++rows;
    EXPECT_LT(gray.at<uchar>(v, first + 1), 60) << v;
    EXPECT_GT(gray.at<uchar>(v, first - 2), 100) << v;
    EXPECT_LT(gray.at<uchar>(v, last - 1), 60) << v;
    EXPECT_GT(gray.at<uchar>(v, last + 2), 100) << v;
  }
  EXPECT_GT(rows, 10);
}

struct Look {
  cv::Scalar bgr;  ///< mean
  int px;
};

/// Of the object that stands last in a world.
Look lookOfLast(const World& world) {
  Rendered r(world);
  const cv::Mat of = r.exact.object == static_cast<int>(r.scene.objects().size()) - 1;
  return {cv::mean(r.renderer.render(r.parts, r.pose, 1), of), cv::countNonZero(of)};
}

TEST(ColorRenderer, ACrowdWithMoreTexturesThanThereMayBeKeepsItsColours) {
  Person red;
  red.path_m = {{3, 2.2}};
  red.shirt = red.trousers = {0.8, 0.1, 0.1};
  World alone = test::exampleWorld(), crowd = alone;
  alone.people = {red};
  Person other;
  for (int i = 0; i < 20; ++i) {
    other.path_m = {{3.5 + 0.4 * (i % 5), 0.6 + 0.8 * (i / 5)}};
    crowd.people.push_back(other);
  }
  crowd.people.push_back(red);
  const Look textured = lookOfLast(alone), plain = lookOfLast(crowd);
  ASSERT_GT(textured.px, 2000);
  ASSERT_EQ(textured.px, plain.px);
  EXPECT_GT(plain.bgr[2], 2 * plain.bgr[1]) << "red";
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(plain.bgr[channel], textured.bgr[channel], 12) << channel;
}

TEST(AmbientLight, CornersAreDarkerThanFreeSurfaces) {
  Rendered r;
  const cv::Mat light = ambientLight(r.exact.depth, r.world.camera->model);
  ASSERT_EQ(light.size(), r.exact.depth.size());
  // Foot of the east wall, 5 m ahead of the start, against the middle of the wall.
  const Eigen::Vector2d foot = r.world.camera->model.project(r.pose.inverse() * Eigen::Vector3d(5, -1, 0.03));
  const Eigen::Vector2d free = r.world.camera->model.project(r.pose.inverse() * Eigen::Vector3d(5, -1, 1.2));
  const auto at = [&](const Eigen::Vector2d& p) {
    return light.at<float>(static_cast<int>(p.y()), static_cast<int>(p.x()));
  };
  EXPECT_LT(at(foot), at(free) - 0.05);
  EXPECT_GT(at(free), 0.9);
}

}  // namespace
}  // namespace roomgraph
