// SPDX-License-Identifier: BSD-3-Clause
// Exact depth and boxes against geometry by hand; occlusion and truncation.
#include "id_raster.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "example_world.h"

namespace roomgraph {
namespace {

struct Picture {
  Scene scene{test::exampleWorld()};
  PinholeCamera camera = test::exampleWorld().camera->model;
  Pose3 world_from_camera = scene.worldFromCamera(0);
  IdImage image = rasterize(scene, scene.partPoses(0), world_from_camera, camera);

  const ObjectView* view(const std::string& kind) const {
    for (const auto& item : image.views)
      if (scene.objects()[static_cast<std::size_t>(item.object)].kind == kind) return &item;
    return nullptr;
  }
};

TEST(IdRaster, DepthOfWallAndFloorIsExact) {
  const Picture p;
  // The east wall is 5 m ahead of the robot, the camera 0.05 m ahead of it.
  for (const auto& [u, v] : {std::pair{320, 200}, {400, 239}, {250, 100}})
    EXPECT_NEAR(p.image.depth.at<float>(v, u), 4.95, 1e-4);
  for (const int v : {400, 440, 479})
    EXPECT_NEAR(p.image.depth.at<float>(v, 500), 0.8 * p.camera.fy / (v - p.camera.cy), 1e-3) << v;
}

TEST(IdRaster, BoxesMatchTheProjectedCorners) {
  const Picture p;
  const auto* block = p.view("block");
  ASSERT_TRUE(block);
  double u0 = 1e9, v0 = 1e9, u1 = -1e9, v1 = -1e9;
  for (const double x : {3.3, 3.7})
    for (const double y : {0.2, 0.8})
      for (const double z : {0.0, 1.0}) {
        const Eigen::Vector2d pixel =
            p.camera.project(p.world_from_camera.inverse() * Eigen::Vector3d(x, y, z));
        u0 = std::min(u0, pixel.x());
        v0 = std::min(v0, pixel.y());
        u1 = std::max(u1, pixel.x());
        v1 = std::max(v1, pixel.y());
      }
  EXPECT_NEAR(block->box.x, u0, 1);
  EXPECT_NEAR(block->box.y, v0, 1);
  EXPECT_NEAR(block->box.br().x, u1, 1);
  EXPECT_NEAR(block->box.br().y, v1, 1);
  EXPECT_EQ(block->box, block->full_box);
  EXPECT_EQ(block->visible, 1);
  EXPECT_EQ(block->in_frame, 1);
  EXPECT_NEAR(block->median_depth_m, 3.25, 0.2);
}

TEST(IdRaster, CountsWhatIsHiddenAndWhatIsCutOff) {
  World world = test::exampleWorld();
  // A second block right behind the first one, a third one half outside on the left.
  Furniture behind = world.furniture[0];
  behind.at_m = {5.3, 2.5, 0};
  behind.size_m = Eigen::Vector3d(0.6, 0.4, 2.0);
  world.furniture.push_back(behind);
  Furniture left = world.furniture[0];
  const double tan_half = 319.5 / 525;
  left.at_m = {3.05, 2 + 1.9 * tan_half, 0};  // its front face, at depth 1.8, straddles the border
  world.furniture.push_back(left);
  const Scene scene(world);
  const auto image = rasterize(scene, scene.partPoses(0), scene.worldFromCamera(0), world.camera->model);
  const auto find = [&](int object) {
    return *std::find_if(image.views.begin(), image.views.end(),
                         [&](const ObjectView& v) { return v.object == object; });
  };
  const ObjectView hidden = find(1), cut = find(2);
  EXPECT_LT(hidden.visible, 0.8);
  EXPECT_GT(hidden.visible, 0.2);
  EXPECT_EQ(hidden.in_frame, 1);
  EXPECT_NEAR(hidden.visible, hidden.unoccluded, 1e-12);
  EXPECT_EQ(cut.box.x, 0);
  EXPECT_LT(cut.full_box.x, -50);
  EXPECT_GT(cut.in_frame, 0.3);
  EXPECT_LT(cut.in_frame, 0.7);
  EXPECT_NEAR(cut.visible, cut.unoccluded * cut.in_frame, 1e-9);
}

TEST(IdRaster, TheNearerObjectWins) {
  const Picture p;
  for (int v = 0; v < p.image.depth.rows; v += 7)
    for (int u = 0; u < p.image.depth.cols; u += 7) {
      const int object = p.image.object.at<short>(v, u);
      if (object != 0) continue;
      const float z = p.image.depth.at<float>(v, u);
      EXPECT_GT(z, 3.2);
      EXPECT_LT(z, 3.7);
    }
}

}  // namespace
}  // namespace roomgraph
