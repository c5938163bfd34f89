// SPDX-License-Identifier: BSD-3-Clause
// Depth mask on rendered scenes with wall and occluder; initialisation score.
#include "depth_clusters.h"

#include <gtest/gtest.h>

#include <limits>

#include "find_edges.h"
#include "initial_score.h"
#include "scene.h"

namespace roomgraph {
namespace {

using test::database;
using test::Scene;

struct Seen {
  Frame frame;
  cv::Mat labels;
  Pose3 ground_from_camera;
};

Seen seenIn(const Scene& scene) {
  Seen seen;
  seen.frame = scene.render(&seen.labels);
  seen.ground_from_camera = cameraFromGround(groundInCamera(scene.world_from_camera)).inverse();
  return seen;
}

// A chair-sized cylinder (object 1) before a wall (object 2), partly covered by a post nearer to the camera
// (3).
Seen chairBeforeWall(bool post) {
  Scene scene;
  scene.lookAhead(0.8, 0.2);
  scene.addCylinder(2.0, 0.1, 0.3, 0.95, 1);
  scene.addBox(3.0, 0, 0, 6, 0.2, 0, 3, 2);
  if (post) scene.addBox(1.0, 0.16, 0, 0.05, 0.05, 0, 1.2, 3);
  return seenIn(scene);
}

double shareOf(const DepthMask& mask, int object, const cv::Mat& labels) {
  double n = 0;
  for (const auto& p : mask.points)
    n += labels.at<int>(static_cast<int>(p.v), static_cast<int>(p.u)) == object;
  return mask.points.empty() ? 0 : n / static_cast<double>(mask.points.size());
}

TEST(DepthMask, GroundWallAndOccluderAreRemoved) {
  for (const bool post : {false, true}) {
    const Seen seen = chairBeforeWall(post);
    const Detection detection = test::detectionOf(1, seen.labels, "swivel_chair");
    const DepthMask all = sampleBox(seen.frame, detection, seen.ground_from_camera);
    const DepthMask mask =
        explanations(all, sampleRing(seen.frame, detection.box, seen.ground_from_camera), detection.box,
                     *database().find("swivel_chair"), seen.frame.camera.fx, 1)
            .at(0);
    EXPECT_GT(mask.points.size(), 200u);
    EXPECT_LE(all.points.size(), 1700u);
    EXPECT_GT(shareOf(mask, 1, seen.labels), 0.97);
    EXPECT_NEAR(mask.valid_ratio, 1, 0.01);
  }
}

TEST(DepthMask, TheDetectorsMaskIsHonoured) {
  const Seen seen = chairBeforeWall(false);
  Detection detection = test::detectionOf(1, seen.labels, "swivel_chair");
  detection.mask = cv::Mat::zeros(10, 10, CV_8UC1);
  detection.mask(cv::Rect(0, 0, 5, 10)).setTo(255);  // left half
  const DepthMask all = sampleBox(seen.frame, detection, seen.ground_from_camera);
  ASSERT_FALSE(all.points.empty());
  for (const auto& p : all.points) EXPECT_LT(p.u, detection.box.center().x() + 1);
}

// Points on an upright patch 4 m away, one for each pixel of the columns [from, to) and 50 rows from `bottom`
// (m) on.
void addPatch(int from, int to, double bottom, DepthMask& all) {
  for (int u = from; u < to; ++u)
    for (int v = 0; v < 50; ++v) {
      const double metres_per_px = 4 / 262.5;
      all.points.push_back({static_cast<double>(u),
                            static_cast<double>(v),
                            {4, (50 - u) * metres_per_px, bottom + (49 - v) * metres_per_px}});
    }
  all.valid_ratio = 1;
}

TEST(DepthMask, WhatStandsInTheMiddleOfTheBoxIsTheObject) {
  DepthMask all;
  addPatch(0, 24, 0.15, all);  // larger, but beside it
  addPatch(45, 65, 0.15, all);
  const DepthMask mask =
      explanations(all, {}, {0, 0, 100, 50}, *database().find("swivel_chair"), 262.5, 1).at(0);
  EXPECT_EQ(mask.points.size(), 20u * 50);
  for (const auto& p : mask.points) EXPECT_GE(p.u, 45);
}

// The seat hides the foot of the back rest, so that their points do not touch.
TEST(DepthMask, ABackRestBehindTheSeatBelongsToASofa) {
  const auto sizeWith = [](double behind) {
    DepthMask all;
    addPatch(0, 100, 0.15, all);
    DepthMask back;
    addPatch(20, 80, 0.15, back);
    for (MaskPoint p : back.points) {
      p.in_ground.x() += behind;
      if (p.in_ground.z() > 0.5) all.points.push_back(p);
    }
    return std::pair{
        explanations(all, {}, {0, 0, 100, 50}, *database().find("sofa"), 262.5, 1).at(0).points.size(),
        all.points.size()};
  };
  const auto near = sizeWith(0.6), far = sizeWith(1.1);
  EXPECT_EQ(near.first, near.second);
  EXPECT_EQ(far.first, 100u * 50) << "farther behind than a sofa is deep";
}

// A chair half behind a cupboard, which is nearer and most of what is in the chair's box, but goes on beyond
// it.
TEST(DepthMask, WhatGoesOnBeyondTheBoxIsNotTheObject) {
  Scene scene = test::sceneAhead();
  scene.addCylinder(2.6, 0.0, 0.3, 0.95, 1);
  scene.addBox(1.5, -0.53, 0, 1.1, 0.3, 0, 1.6, 3);
  const Seen seen = seenIn(scene);
  Scene alone = test::sceneAhead();
  alone.addCylinder(2.6, 0.0, 0.3, 0.95, 1);
  const Detection detection = test::detectionOf(1, seenIn(alone).labels, "swivel_chair");
  const DepthMask all = sampleBox(seen.frame, detection, seen.ground_from_camera);
  ASSERT_GT(shareOf(all, 3, seen.labels), 0.5);
  const auto masks = explanations(all, sampleRing(seen.frame, detection.box, seen.ground_from_camera),
                                  detection.box, *database().find("swivel_chair"), seen.frame.camera.fx, 2);
  ASSERT_EQ(masks.size(), 2U);
  EXPECT_GT(shareOf(masks[0], 1, seen.labels), 0.97);
  EXPECT_LT(masks[0].goes_on, 0.1);
  EXPECT_GT(shareOf(masks[1], 3, seen.labels), 0.9);
  EXPECT_GT(masks[1].goes_on, 0.9);
}

TEST(DepthMask, NothingToSample) {
  Seen seen = chairBeforeWall(false);
  Detection detection;
  EXPECT_TRUE(sampleBox(seen.frame, detection, seen.ground_from_camera).points.empty());
  detection.box = {-500, -500, -10, -10};
  EXPECT_TRUE(sampleBox(seen.frame, detection, seen.ground_from_camera).points.empty());
  detection.box = {-500, -500, 5000, 5000};
  seen.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const DepthMask all = sampleBox(seen.frame, detection, seen.ground_from_camera);
  EXPECT_TRUE(all.points.empty());
  EXPECT_EQ(all.valid_ratio, 0);
  EXPECT_TRUE(explanations(all, {}, {0, 0, 320, 240}, *database().find("sofa"), 262, 1).empty());
  seen.frame.depth = cv::Mat();
  EXPECT_TRUE(sampleBox(seen.frame, detection, seen.ground_from_camera).points.empty());
}

InitialScore scoreOf(const Frame& frame, const Box2& box, double depth) {
  BoxEvidence evidence;
  evidence.camera = frame.camera;
  evidence.box = box;
  evidence.segments = findEdges(frame, box).segments;
  evidence.mask.valid_ratio = depth;
  return initialScore(evidence);
}

TEST(InitialScore, GrowsWithAreaEdgesAndDepth) {
  Frame frame;
  frame.camera = {320, 240, 262.5, 262.5, 159.5, 119.5, {}};
  const Box2 small{100, 100, 130, 130}, large{40, 40, 200, 200};
  EXPECT_GT(scoreOf(frame, large, 0.5).value, scoreOf(frame, small, 0.5).value);
  EXPECT_GT(scoreOf(frame, small, 1.0).value, scoreOf(frame, small, 0.2).value);
  EXPECT_EQ(scoreOf(frame, small, 0.5).edges, 0);
  frame.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(60));
  EXPECT_EQ(scoreOf(frame, large, 0.5).edges, 0);
  frame.gray(cv::Rect(70, 70, 90, 90)).setTo(200);
  const InitialScore framed = scoreOf(frame, large, 1.0);
  EXPECT_GT(framed.edges, 0.3);
  EXPECT_LE(framed.value, 1);
  EXPECT_EQ(scoreOf(frame, Box2{}, 1.0).value, 0);
}

}  // namespace
}  // namespace roomgraph
