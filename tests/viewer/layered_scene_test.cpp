// SPDX-License-Identifier: BSD-3-Clause
// LayeredScene: which objects stand in which layer, where and in which colour, and what is made again.
#include "roomgraph/viewer/layered_scene.h"

#include <gtest/gtest.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>

#include <Eigen/Eigenvalues>

#include "made_up_states.h"
#include "scene_marks.h"

namespace roomgraph::test {
namespace {

using mrpt::opengl::CSetOfObjects;
using mrpt::opengl::CSetOfTriangles;

const ObjectDatabase& classes() {
  static const ObjectDatabase database = ObjectDatabase::fromText(
      "[swivel_chair]\nlabels=chair\ncolor=#e6862a\n[sofa]\nlabels=couch\ncolor=#3f7fd0\n"
      "[door]\nlabels=door\ncolor=#3aa657\n[person]\nlabels=person\ncolor=#ff00ff\nmoves=true\nlandmark="
      "false\n");
  return database;
}

/// Everything a state can hold, at record 39 of the sample map.
std::shared_ptr<ViewState> fullState() {
  const CSemanticMap map = sampleMap();
  auto state = stateAt(39);
  auto path = std::make_shared<ShownPath>();
  for (const auto& pose : map.world_from_robot) path->push_back(toShown(pose));
  state->t = map.world_from_robot.back().t;
  state->world_from_robot = map.world_from_robot.back().pose;
  state->grid = map.occupancy;
  state->path = path;
  state->key_poses = std::make_shared<const ShownPath>(ShownPath{path->at(0), path->at(20), path->at(39)});
  auto landmarks = std::make_shared<ShownLandmarks>();
  for (const auto& landmark : map.landmarks)
    landmarks->push_back(shownLandmark(landmark, landmark.id.value != 7));
  state->landmarks = landmarks;
  state->closures = std::make_shared<const std::vector<ShownClosure>>(
      std::vector<ShownClosure>{{path->at(0).t, path->at(39).t}, {path->at(0).t, path->at(39).t + 50}});
  state->scan = {{1, 1, 0.2f}, {2, 1, 0.2f}};
  state->people = {{"person", {ShapeKind::kCylinder, 0.5, 0.5, 1.7}, poseFromYpr(2, -1, 0, 0, 0, 0)}};
  state->proposals = {{"sofa", {ShapeKind::kCuboid, 1.8, 0.8, 0.8}, poseFromYpr(3, -1, 0, 0, 0, 0)}};
  return state;
}

CSetOfObjects& layerOf(const LayeredScene& scene, Layer layer) {
  const auto name = std::string(kLayerNames[static_cast<std::size_t>(layer)]);
  return *std::dynamic_pointer_cast<CSetOfObjects>(scene.scene()->getByName(name));
}

std::vector<std::string> namesIn(CSetOfObjects& group) {
  std::vector<std::string> names;
  for (const auto& object : group) names.push_back(object->getName());
  return names;
}

Eigen::AlignedBox3d boundsOfTriangles(const CSetOfTriangles& set) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < set.getTrianglesCount(); ++i) {
    mrpt::opengl::TTriangle triangle;
    set.getTriangle(i, triangle);
    for (std::size_t k = 0; k < 3; ++k)
      box.extend(Eigen::Vector3d(static_cast<double>(triangle.x(k)), static_cast<double>(triangle.y(k)),
                                 static_cast<double>(triangle.z(k))));
  }
  return box;
}

const CSetOfTriangles& meshIn(CSetOfObjects& group, std::size_t index) {
  auto at = group.begin();
  std::advance(at, static_cast<std::ptrdiff_t>(index));
  return dynamic_cast<const CSetOfTriangles&>(**at);
}

TEST(LayeredScene, EveryLayerHoldsItsObjects) {
  LayeredScene scene(classes());
  scene.show(fullState(), {});
  const auto names = [&](Layer layer) { return namesIn(layerOf(scene, layer)); };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(Layer::kGrid), (Names{"floor", "metre grid", "walls"}));
  EXPECT_EQ(names(Layer::kTrajectory), Names{"path"});
  EXPECT_EQ(names(Layer::kKeyPoses), Names{"key poses"});
  EXPECT_EQ(names(Layer::kClosures), Names{"closures"});
  EXPECT_EQ(names(Layer::kLandmarks), (Names{"swivel_chair 1", "sofa 2", "name 1", "name 2"}))
      << "not the candidate";
  EXPECT_EQ(names(Layer::kCovariances), (Names{"covariance 1", "covariance 2"}));
  EXPECT_EQ(names(Layer::kProposals), (Names{"frame", "frame"})) << "one of the frame, and a candidate";
  EXPECT_EQ(names(Layer::kScan), Names{"points"});
  EXPECT_EQ(names(Layer::kPeople), Names{"frame"});
  EXPECT_EQ(scene.map().landmarks.size(), 2u);
}

TEST(LayeredScene, LayersAreShownAndHidden) {
  LayeredScene scene(classes());
  scene.show(fullState(), {});
  for (std::size_t i = 0; i < kLayerNames.size(); ++i) {
    const auto layer = static_cast<Layer>(i);
    EXPECT_TRUE(scene.visible(layer)) << kLayerNames[i];
    scene.setVisible(layer, false);
    EXPECT_FALSE(layerOf(scene, layer).isVisible()) << kLayerNames[i];
  }
  scene.show(stateAt(40), {});
  EXPECT_FALSE(scene.visible(Layer::kLandmarks)) << "for the next state, too";
  scene.setVisible(Layer::kLandmarks, true);
  EXPECT_TRUE(scene.visible(Layer::kLandmarks));
}

TEST(LayeredScene, TheSelectedObjectIsMarked) {
  LayeredScene scene(classes());
  const auto state = fullState();
  scene.show(state, LandmarkId{2});
  auto& layer = layerOf(scene, Layer::kLandmarks);
  ASSERT_EQ(namesIn(layer).back(), "frame");
  const auto box = boundsOfTriangles(meshIn(layer, 4));
  EXPECT_LT((box.center().head<2>() - Eigen::Vector2d(3.6, -1.0)).norm(), 0.02) << "where the sofa is";
  EXPECT_NEAR(box.sizes().z(), 0.92, 0.05) << "as high as it is";
  scene.show(state, {});
  EXPECT_EQ(namesIn(layer).back(), "name 2") << "no more";
  scene.show(state, LandmarkId{99});
  EXPECT_EQ(namesIn(layer).back(), "name 2") << "what is not there is not marked";
}

TEST(LayeredScene, OnlyWhatChangedIsMadeAgain) {
  LayeredScene scene(classes());
  const auto first = fullState();
  scene.show(first, {});
  const auto floor = *layerOf(scene, Layer::kGrid).begin();
  const auto chair = *layerOf(scene, Layer::kLandmarks).begin();
  const auto path = *layerOf(scene, Layer::kTrajectory).begin();
  auto second = std::make_shared<ViewState>(*first);
  second->t -= 1;
  scene.show(second, {});
  EXPECT_EQ(*layerOf(scene, Layer::kGrid).begin(), floor);
  EXPECT_EQ(*layerOf(scene, Layer::kLandmarks).begin(), chair);
  EXPECT_NE(*layerOf(scene, Layer::kTrajectory).begin(), path);
  second = std::make_shared<ViewState>(*second);
  second->grid = sampleMap().occupancy;
  second->landmarks = std::make_shared<const ShownLandmarks>();
  scene.show(second, {});
  EXPECT_NE(*layerOf(scene, Layer::kGrid).begin(), floor);
  EXPECT_EQ(namesIn(layerOf(scene, Layer::kLandmarks)).size(), 0u);
}

TEST(LayeredScene, ThePathEndsWhereTheRobotIs) {
  LayeredScene scene(classes());
  auto state = fullState();
  scene.show(state, {});
  EXPECT_EQ(scene.map().world_from_robot.size(), 40u);
  state = std::make_shared<ViewState>(*state);
  state->t += 1;
  state->world_from_robot = poseFromYpr(4, 1, 0, 0, 0, 0);
  scene.show(state, {});
  ASSERT_EQ(scene.map().world_from_robot.size(), 41u) << "the way since the last pose of the path";
  EXPECT_NEAR(scene.map().world_from_robot.back().pose.translation().x(), 4, 1e-12);
  state = std::make_shared<ViewState>(*state);
  state->t -= 3;
  scene.show(state, {});
  EXPECT_LT(scene.map().world_from_robot.size(), 25u) << "back in time it is shorter";
}

TEST(SceneMarks, ClosuresRunBetweenThePlacesAtTheirTimes) {
  LayeredScene scene(classes());
  const auto state = fullState();
  scene.show(state, {});
  const auto box = boundsOfTriangles(meshIn(layerOf(scene, Layer::kClosures), 0));
  const Eigen::Vector3d begin = sampleMap().world_from_robot.front().pose.translation(),
                        end = sampleMap().world_from_robot.back().pose.translation();
  EXPECT_NEAR(box.min().x(), begin.x(), 0.02);
  EXPECT_NEAR(box.max().x(), end.x(), 0.02) << "the second one ends later than the path";
  EXPECT_NEAR(box.min().y(), end.y(), 0.02);
}

TEST(SceneMarks, NamesHaveAQuestionMarkForWhatMrptCannotWrite) {
  mrpt::opengl::COpenGLScene scene;
  Landmark landmark = sampleLandmark(3, "Drehst\u00fchle_\u6905\u5b50", ShapeKind::kCuboid, 0, 0);
  addName(landmark, scene);
  const auto text = scene.getByClass<mrpt::opengl::CText>();
  ASSERT_TRUE(text);
  EXPECT_EQ(text->getString(), "Drehst?hle ?? 3");
}

TEST(SceneMarks, TheEllipseHolds95Percent) {
  Eigen::Matrix2d covariance;
  covariance << 0.05, 0.02, 0.02, 0.03;
  const Eigen::Vector2d mean(1, -2);
  const auto points = ellipse95(mean, covariance, 90);
  ASSERT_EQ(points.size(), 90u);
  // P(d² < q) = 1 - exp(-q / 2) for two degrees of freedom.
  for (const auto& point : points) {
    const double d2 = (point - mean).dot(covariance.inverse() * (point - mean));
    EXPECT_NEAR(1 - std::exp(-d2 / 2), 0.95, 1e-4);
  }
  Eigen::AlignedBox2d box;
  for (const auto& point : points) box.extend(point);
  EXPECT_NEAR(box.sizes().x(), 2 * std::sqrt(5.991 * 0.05), 0.005) << "it goes all around";
  EXPECT_EQ(ellipse95(mean, -covariance, 4).front(), mean) << "a covariance that is none";
}

TEST(SceneMarks, PointsAndKeyPosesAreWhereTheyAre) {
  COpenGLScene scene;
  addPoints({{1, 2, 0.5f}}, 0.02, {255, 0, 0}, scene);
  addKeyPoses({{0, poseFromYpr(3, 1, 0.7, M_PI / 2, 0, 0)}}, true, 0.2, {0, 0, 255}, scene);
  auto& points = *std::dynamic_pointer_cast<CSetOfTriangles>(scene.getByName("points"));
  EXPECT_LT((boundsOfTriangles(points).center() - Eigen::Vector3d(1, 2, 0.5)).norm(), 1e-6);
  auto& poses = *std::dynamic_pointer_cast<CSetOfTriangles>(scene.getByName("key poses"));
  const auto box = boundsOfTriangles(poses);
  EXPECT_LT(box.max().z(), 0.1) << "a robot is on the floor";
  EXPECT_NEAR(box.max().y(), 1.2, 1e-6) << "the nose points forwards";
  EXPECT_NEAR(box.min().y(), 0.9, 1e-6);
}

}  // namespace
}  // namespace roomgraph::test
