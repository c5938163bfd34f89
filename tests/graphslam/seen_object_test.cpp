// SPDX-License-Identifier: BSD-3-Clause
// Objects seen from nodes: text and means.
#include "roomgraph/graphslam/seen_object.h"

#include <gtest/gtest.h>

#include <numbers>

namespace roomgraph {
namespace {

SeenObject seen(int landmark, const std::string& name, const Pose3& node_from_object) {
  return {LandmarkId{landmark}, name, node_from_object, {0.5, 0.4, 0.9}};
}

TEST(SeenObject, IsDescribedByClassNumberAndPlace) {
  EXPECT_EQ(describe({}), "");
  EXPECT_EQ(describe({seen(3, "chair", poseFromYpr(1.2, 0.4, 0, 0, 0, 0)), seen(1, "door", poseFromYpr(-2, 0, 0.1, 0, 0, 0))}),
            "chair 3 (1.20 0.40 0.00), door 1 (-2.00 0.00 0.10)");
}

// A chair at (3, 2) that looks along -x, seen from two nodes, once 0.1 m too far to each side; yaw on both sides of pi.
TEST(SeenObject, IsPlacedAtTheMeanOverNodes) {
  const Pose3 first = poseFromYpr(1, 0, 0, 0.5, 0, 0), second = poseFromYpr(0, 3, 0, -1, 0, 0);
  const double pi = std::numbers::pi;
  const Pose3 one = poseFromYpr(3, 2.1, 0, pi - 0.1, 0, 0), other = poseFromYpr(3, 1.9, 0, -pi + 0.1, 0, 0);
  const auto placed = placeObjects({{first, {seen(7, "chair", first.inverse() * one)}},
                                    {second, {seen(7, "chair", second.inverse() * other), seen(8, "sofa", Pose3::Identity())}},
                                    {Pose3::Identity(), {}}});
  ASSERT_EQ(placed.size(), 2u);
  const PlacedObject& chair = placed.at(LandmarkId{7});
  EXPECT_EQ(chair.class_name, "chair");
  EXPECT_EQ(chair.nodes, 2);
  EXPECT_LT((chair.position - Eigen::Vector3d(3, 2, 0)).norm(), 1e-9);
  EXPECT_NEAR(std::abs(wrapAngle(chair.yaw - pi)), 0, 1e-9);
  EXPECT_LT((chair.size_m - Eigen::Vector3d(0.5, 0.4, 0.9)).norm(), 1e-12);
  EXPECT_EQ(placed.at(LandmarkId{8}).nodes, 1);
  EXPECT_LT((placed.at(LandmarkId{8}).position - second.translation()).norm(), 1e-9);
}

// A dozen looks from afar, which all err to one side, beside thirty from near.
TEST(SeenObject, SightingsWeighByWhatTheyKnow) {
  std::vector<std::pair<Pose3, std::vector<SeenObject>>> nodes;
  for (int i = 0; i < 42; ++i) {
    const bool near = i < 30;
    SeenObject door = seen(2, "door", poseFromYpr(near ? 7 : 4.6, 0, 0, i % 2 ? 0 : std::numbers::pi, 0, 0));
    door.sigma_m = near ? 0.02 : 0.5;
    door.symmetry = 2;
    nodes.emplace_back(Pose3::Identity(), std::vector{door});
  }
  EXPECT_NEAR(placeObjects(nodes).at(LandmarkId{2}).position.x(), 7, 0.01);
  const PlacedObject door = placeObjects(nodes).at(LandmarkId{2});
  EXPECT_TRUE(door.has_yaw);
  EXPECT_NEAR(std::abs(std::sin(door.yaw)), 0, 1e-6) << "both faces look alike";
  for (auto& [node, objects] : nodes) objects[0].sigma_m = 0.1;
  EXPECT_NEAR(placeObjects(nodes).at(LandmarkId{2}).position.x(), 7, 0.05) << "most are near, none knows better";
  nodes.resize(1);
  nodes[0].second[0].symmetry = 0;
  EXPECT_FALSE(placeObjects(nodes).at(LandmarkId{2}).has_yaw);
}

TEST(SeenObject, TheClassOfMostSightingsIsItsClass) {
  const auto placed = placeObjects({{Pose3::Identity(), {seen(1, "sofa", Pose3::Identity())}},
                                    {Pose3::Identity(), {seen(1, "chair", Pose3::Identity())}},
                                    {Pose3::Identity(), {seen(1, "sofa", Pose3::Identity())}}});
  EXPECT_EQ(placed.at(LandmarkId{1}).class_name, "sofa");
}

}  // namespace
}  // namespace roomgraph
