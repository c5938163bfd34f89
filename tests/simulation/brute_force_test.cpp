// SPDX-License-Identifier: BSD-3-Clause
// Depth image, object image and lidar of a furnished room against brute-force ray casting.
#include <gtest/gtest.h>

#include <numbers>

#include "example_world.h"
#include "id_raster.h"
#include "roomgraph/core/random.h"
#include "scene_rays.h"
#include "sensors.h"

namespace roomgraph {
namespace {

/// The example with a chair right before the camera, a sofa and a plant.
World furnishedWorld() {
  World world = test::exampleWorld();
  world.camera->model = {160, 120, 131, 131, 79.5, 59.5, {}};
  world.camera->pitch_down_rad = 0.3;
  const auto add = [&](const std::string& model, double x, double y, double yaw) {
    Furniture item;
    item.model = model;
    item.at_m = {x, y, 0};
    item.yaw_rad = yaw;
    world.furniture.push_back(item);
  };
  add("swivel_chair", 1.75, 1.9, 0.4);
  add("sofa", 3.4, 1.0, 1.9);
  add("plant", 2.6, 2.9, 0);
  return world;
}

TEST(IdRaster, EveryPixelIsWhatItsRayMeets) {
  const World world = furnishedWorld();
  const Scene scene(world);
  const PinholeCamera& camera = world.camera->model;
  for (const double t : {0.0, 2.0}) {
    const auto parts = scene.partPoses(t);
    const Pose3 pose = scene.worldFromCamera(t);
    const IdImage image = rasterize(scene, parts, pose, camera);
    int compared = 0, objects = 0;
    for (int v = 1; v < camera.height; v += 7) {
      for (int u = 1; u < camera.width; u += 7) {
        const auto hit = test::firstHit(scene, parts, pose.translation(), pose.linear() * camera.ray(u, v));
        if (hit.distance < 0.0501 || hit.second - hit.distance < 1e-4) continue;  // cut off, or undecided
        ++compared;
        objects += hit.object >= 0;
        EXPECT_NEAR(image.depth.at<float>(v, u), hit.distance, 2e-5 * hit.distance) << u << " " << v;
        EXPECT_EQ(image.object.at<short>(v, u), hit.object) << u << " " << v;
      }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(objects, 60);
  }
}

TEST(IdRaster, WhatIsSaidOfAViewIsCountedInThePicture) {
  const World world = furnishedWorld();
  const Scene scene(world);
  const IdImage image = rasterize(scene, scene.partPoses(1), scene.worldFromCamera(1), world.camera->model);
  EXPECT_GE(image.views.size(), 3u);
  for (const auto& view : image.views) {
    std::vector<float> depths;
    cv::Rect box;
    for (int v = 0; v < image.object.rows; ++v)
      for (int u = 0; u < image.object.cols; ++u) {
        if (image.object.at<short>(v, u) != view.object) continue;
        depths.push_back(image.depth.at<float>(v, u));
        box |= cv::Rect(u, v, 1, 1);
      }
    std::sort(depths.begin(), depths.end());
    EXPECT_EQ(view.px, static_cast<int>(depths.size()));
    EXPECT_EQ(view.box, box);
    EXPECT_EQ(view.full_box & view.box, view.box);
    EXPECT_NEAR(view.median_depth_m, depths[depths.size() / 2], 1e-6);
    EXPECT_LE(view.visible, std::min(view.unoccluded, view.in_frame) + 1e-12);
  }
}

TEST(LidarCaster, EveryBeamMeetsWhatItsRayMeets) {
  const Scene scene(furnishedWorld());
  constexpr double kHeight_m = 0.25;
  const LidarCaster caster(scene, kHeight_m);
  constexpr int kBeams = 91;
  for (const auto& [pose, t] : {std::pair{Pose2{0.9, 0.3, 0.4}, 0.0}, {Pose2{2.2, 1.0, -2.7}, 2.5}}) {
    const auto parts = scene.partPoses(t);
    const auto ranges = caster.cast(pose, kBeams, t);
    ASSERT_EQ(ranges.size(), static_cast<std::size_t>(kBeams));
    int persons = 0;
    for (int i = 0; i < kBeams; ++i) {
      const double angle = pose.yaw - std::numbers::pi + i * 2 * std::numbers::pi / (kBeams - 1);
      const auto hit = test::firstHit(scene, parts, {pose.x, pose.y, kHeight_m},
                                         {std::cos(angle), std::sin(angle), 0});
      EXPECT_NEAR(ranges[static_cast<std::size_t>(i)], hit.distance, 1e-5) << i;
      persons += hit.object >= 0 && scene.objects()[static_cast<std::size_t>(hit.object)].kind == "person";
    }
    // The first and the last beam both look straight back.
    EXPECT_NEAR(ranges.front(), ranges.back(), 1e-9);
    if (t > 0) {
      EXPECT_GT(persons, 0);
    }
  }
}

}  // namespace
}  // namespace roomgraph
