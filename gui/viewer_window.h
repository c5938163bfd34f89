// SPDX-License-Identifier: BSD-3-Clause
// ViewerWindow: the 3D map, the camera's image, what is known of an object, and the controls.
#pragma once

#include <mrpt/gui/CDisplayWindowGUI.h>

#include <chrono>
#include <memory>
#include <optional>

#include "control_bar.h"
#include "object_panel.h"
#include "roomgraph/rendering/orbit_camera.h"
#include "roomgraph/viewer/playback.h"
#include "roomgraph/viewer/viewer_request.h"

namespace roomgraph {

/// All of it happens in the thread of nanogui's main loop.
class ViewerWindow : public mrpt::gui::CDisplayWindowGUI {
 public:
  explicit ViewerWindow(const ViewerRequest& request);
  void drawAll() override;
  /// Throws what went wrong while a picture was saved.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 protected:
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) override;

 private:
  using Clock = std::chrono::steady_clock;
  enum class View { kFree, kFollow, kTop };

  Commands commands();
  bool onKey(int key, int action, int modifiers);
  void tick();
  void takeStates();
  void showState();
  void showImage();
  void showObject();
  void showStatus();
  void placeParts();
  void moveCamera();
  void fitView(View view);
  OrbitCamera camera() const;
  void setCamera(const OrbitCamera& camera);
  void select(const nanogui::Vector2i& pixel);
  void save();
  void leave();

  const ViewerRequest& request_;
  Timeline timeline_;
  Playback playback_;
  LayeredScene scene_;
  mrpt::opengl::COpenGLViewport::Ptr image_viewport_;
  std::optional<ControlBar> bar_;
  std::optional<LayerPanel> layers_;
  std::optional<ObjectPanel> object_;

  View view_ = View::kFree;
  bool fitted_ = false;             ///< whether the camera was ever fitted to the map
  double fitted_extent_ = 0;        ///< of the map when it was, m
  std::size_t fitted_objects_ = 0;  ///< in it
  std::optional<OrbitCamera> set_;  ///< as this program left it; another now: somebody moved it
  LandmarkId selected_;
  std::shared_ptr<const ViewState> shown_;
  std::shared_ptr<const SeenFrame> newest_frame_;
  std::optional<double> image_t_;  ///< of the image that is shown
  LandmarkId image_of_;            ///< whose best view is shown
  nanogui::Vector2i pressed_at_{0, 0}, placed_for_{0, 0};
  Clock::time_point opened_ = Clock::now(), last_tick_ = opened_;
  bool save_ = false, leaving_ = false;
  std::string message_;
  std::exception_ptr error_;
};

}  // namespace roomgraph
