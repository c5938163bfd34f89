// SPDX-License-Identifier: BSD-3-Clause
// Local bundle adjustment on exact keyframes, and consistency of the local map.
#include "bundle_adjustment.h"

#include <gtest/gtest.h>

#include <random>

namespace roomgraph::tracking {
namespace {

/// Three keyframes side by side which all see the same 120 points exactly.
struct World {
  LocalMap map;
  std::vector<Pose3> truth;
  std::vector<Eigen::Vector3d> places;

  World() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 120; ++i) places.emplace_back(unit(random), 0.8 * unit(random), 3 + unit(random));
    for (int k = 0; k < 3; ++k) addKeyframe(k);
    for (int i = 0; i < 120; ++i) {
      const auto id = map.createPoint(0, i);
      for (int k = 1; k < 3; ++k) map.addSighting(id, k, i);
    }
  }

  void addKeyframe(int k) {
    Keyframe keyframe;
    keyframe.camera = {640, 480, 525, 525, 320, 240, {}};
    keyframe.odom_from_camera.translation() << 0.15 * k, 0.05 * k, 0;
    truth.push_back(keyframe.odom_from_camera);
    for (const auto& place : places) {
      const Eigen::Vector3d p = keyframe.odom_from_camera.inverse() * place;
      const Eigen::Vector2d pixel = keyframe.camera.project(p);
      keyframe.features.places.push_back({cv::Point2d(pixel.x(), pixel.y())});
      keyframe.features.descriptors.emplace_back();
      keyframe.features.depth.push_back(static_cast<float>(p.z()));
    }
    keyframe.points.assign(places.size(), -1);
    map.keyframes.push_back(keyframe);
  }
};

TEST(BundleAdjustment, BringsKeyframesAndPointsBack) {
  World world;
  world.map.keyframe(1).odom_from_camera = world.truth[1] * poseFromYpr(0.01, 0.01, 0.01, 0.01, 0.01, 0.01);
  world.map.keyframe(2).odom_from_camera = world.truth[2] * poseFromYpr(-0.015, -0.015, -0.015, -0.015, -0.015, -0.015);
  for (std::size_t i = 0; i < world.map.points.size(); ++i) world.map.points[i].position += Eigen::Vector3d(0.005, 0.01, -0.02);
  TrackingParameters parameters;
  parameters.ba_iterations = 20;
  adjustLocally(world.map, 2, parameters);
  for (int k = 0; k < 3; ++k) {
    const Pose3 error =
        world.truth[static_cast<std::size_t>(k)].inverse() * world.map.keyframe(k).odom_from_camera;
    EXPECT_LT(error.translation().norm(), 1e-3) << k;
    EXPECT_LT(rotationAngle(error), 1e-3) << k;
  }
  for (std::size_t i = 0; i < world.places.size(); ++i)
    EXPECT_LT((world.map.points[i].position - world.places[i]).norm(), 5e-3);
}

TEST(BundleAdjustment, RemovesSightingsThatDoNotFit) {
  World world;
  world.map.keyframe(2).features.places[7].pt.x += 30;
  adjustLocally(world.map, 2, {});
  EXPECT_EQ(world.map.keyframe(2).points[7], -1);
  EXPECT_EQ(world.map.point(7).sightings.size(), 2u);
  EXPECT_EQ(world.map.keyframe(2).points[8], 8);
}

TEST(LocalMap, KeepsBothDirectionsConsistent) {
  World world;
  world.map.removeSighting(3, 1);
  EXPECT_EQ(world.map.keyframe(1).points[3], -1);
  world.map.erase(4);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(world.map.keyframe(k).points[4], -1);
  EXPECT_TRUE(world.map.point(4).erased);
  const auto votes = world.map.covisible(world.map.keyframe(0).points);
  ASSERT_EQ(votes.size(), 3u);
  EXPECT_EQ(votes.back(), std::make_pair(118, 1));
}

}  // namespace
}  // namespace roomgraph::tracking
