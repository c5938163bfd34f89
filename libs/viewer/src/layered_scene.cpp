// SPDX-License-Identifier: BSD-3-Clause
// Layers of the scene from the parts that pictures of maps have, and from what only a run has.
#include "roomgraph/viewer/layered_scene.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/rendering/palette.h"
#include "roomgraph/rendering/scene_parts.h"
#include "scene_marks.h"

namespace roomgraph {
namespace {

const palette::TColor kClosureColor{214, 48, 49}, kScanColor{225, 60, 60}, kMarkColor{255, 196, 0};

}  // namespace

LayeredScene::LayeredScene(const ObjectDatabase& database) : database_(database) {
  scene_->getViewport()->setCustomBackgroundColor(mrpt::img::TColorf(palette::kUnknown));
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    groups_[i] = mrpt::opengl::CSetOfObjects::Create();
    groups_[i]->setName(std::string(kLayerNames[i]));
    scene_->insert(groups_[i]);
  }
}

bool LayeredScene::visible(Layer layer) const {
  return groups_[static_cast<std::size_t>(layer)]->isVisible();
}

void LayeredScene::setVisible(Layer layer, bool visible) {
  groups_[static_cast<std::size_t>(layer)]->setVisibility(visible);
}

void LayeredScene::fill(Layer layer, const Part& part) {
  mrpt::opengl::COpenGLScene made;
  part(made);
  auto& group = *groups_[static_cast<std::size_t>(layer)];
  group.clear();
  for (const auto& object : *made.getViewport()) group.insert(object);
}

void LayeredScene::show(const std::shared_ptr<const ViewState>& state, LandmarkId selected) {
  const std::shared_ptr<const ViewState> before = std::exchange(state_, state);
  if (before == state && selected == selected_) return;
  map_.planar = state->planar;
  if (!before || before->grid != state->grid) showGrid();
  if (before != state) showPath();
  if (!before || before->landmarks != state->landmarks || selected != selected_) showLandmarks(selected);
  selected_ = selected;
  if (before == state) return;
  fill(Layer::kScan, [&](auto& scene) { addPoints(state->scan, lineWidth(map_), kScanColor, scene); });
  const auto shapes = [&](const std::vector<ShownShape>& all) {
    return [&](mrpt::opengl::COpenGLScene& scene) {
      for (const auto& shape : all)
        addFrame(shape.shape, shape.world_from_object, lineWidth(map_) / 2,
                 palette::ofClass(database_, shape.class_name), scene);
    };
  };
  fill(Layer::kPeople, shapes(state->people));
  fill(Layer::kProposals, [&](auto& scene) {
    shapes(state->proposals)(scene);
    for (const auto& shown : *state->landmarks)
      if (!shown->in_map)
        addFrame(shown->landmark.shape, shown->landmark.worldFromObject(), lineWidth(map_) / 3,
                 palette::mix(palette::ofClass(database_, shown->landmark.class_name), palette::kFree, 0.4),
                 scene);
  });
}

void LayeredScene::showGrid() {
  // The scene's parts do not write to the grid.
  map_.occupancy = std::const_pointer_cast<mrpt::maps::COccupancyGridMap2D>(state_->grid);
  fill(Layer::kGrid, [&](auto& scene) {
    addFloor(map_, scene);
    addGridLines(map_, scene);
    addWalls(map_, scene);
  });
}

void LayeredScene::showPath() {
  map_.world_from_robot.clear();
  if (state_->path) map_.world_from_robot = pathUntil(*state_->path, state_->t);
  if (state_->record > 0 && (map_.world_from_robot.empty() || map_.world_from_robot.back().t < state_->t))
    map_.world_from_robot.push_back({state_->t, state_->world_from_robot});
  fill(Layer::kTrajectory, [&](auto& scene) { addPath(map_, scene); });
  const std::vector<StampedPose> keys =
      state_->key_poses ? pathUntil(*state_->key_poses, state_->t) : std::vector<StampedPose>{};
  fill(Layer::kKeyPoses, [&](auto& scene) {
    addKeyPoses(keys, state_->planar, 2.4 * lineWidth(map_), palette::kPathEnd, scene);
  });
  fill(Layer::kClosures, [&](auto& scene) {
    if (state_->closures) addClosures(*state_->closures, map_, 0.8 * lineWidth(map_), kClosureColor, scene);
  });
}

void LayeredScene::showLandmarks(LandmarkId selected) {
  map_.landmarks.clear();
  if (state_->landmarks)
    for (const auto& shown : *state_->landmarks)
      if (shown->in_map) map_.landmarks.push_back(shown->landmark);
  const ShownLandmark* marked = findLandmark(*state_, selected);
  fill(Layer::kLandmarks, [&](auto& scene) {
    addLandmarks(map_, database_, scene);
    for (const auto& landmark : map_.landmarks) addName(landmark, scene);
    if (marked)
      addFrame(marked->landmark.shape, marked->landmark.worldFromObject(), 1.3 * lineWidth(map_), kMarkColor,
               scene);
  });
  fill(Layer::kCovariances, [&](auto& scene) {
    for (const auto& landmark : map_.landmarks)
      addCovariance(landmark, lineWidth(map_) / 2,
                    palette::mix(palette::ofClass(database_, landmark.class_name), {0, 0, 0}, 0.35), scene);
  });
}

}  // namespace roomgraph
