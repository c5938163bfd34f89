// SPDX-License-Identifier: BSD-3-Clause
// LayeredScene: the OpenGL scene of one moment, in layers that are shown or not.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <array>
#include <functional>
#include <string_view>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

enum class Layer {
  kGrid,
  kTrajectory,
  kKeyPoses,
  kClosures,
  kLandmarks,
  kCovariances,
  kProposals,
  kScan,
  kPeople
};

/// In the order of Layer.
inline constexpr std::array<std::string_view, 9> kLayerNames{"grid",          "trajectory", "key poses",
                                                             "loop closures", "landmarks",  "covariances",
                                                             "proposals",     "scan",       "people"};

/// Objects of the scene stand in one group for each layer, which has the layer's name. Only what changed
/// since the last state is made again.
class LayeredScene {
 public:
  /// The database, which outlives the scene, has the classes' colours.
  explicit LayeredScene(const ObjectDatabase& database);

  const mrpt::opengl::COpenGLScene::Ptr& scene() const { return scene_; }
  bool visible(Layer layer) const;
  void setVisible(Layer layer, bool visible);
  /// `selected`: a landmark that is marked; invalid: none.
  void show(const std::shared_ptr<const ViewState>& state, LandmarkId selected);
  /// What is shown, as a map: for the fit of a camera.
  const CSemanticMap& map() const { return map_; }

 private:
  using Part = std::function<void(mrpt::opengl::COpenGLScene&)>;
  void fill(Layer layer, const Part& part);
  void showGrid();
  void showPath();
  void showLandmarks(LandmarkId selected);

  const ObjectDatabase& database_;
  mrpt::opengl::COpenGLScene::Ptr scene_ = mrpt::opengl::COpenGLScene::Create();
  std::array<mrpt::opengl::CSetOfObjects::Ptr, kLayerNames.size()> groups_;
  std::shared_ptr<const ViewState> state_;
  LandmarkId selected_;
  CSemanticMap map_;
};

}  // namespace roomgraph
