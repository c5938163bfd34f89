// SPDX-License-Identifier: BSD-3-Clause
// Loop of the window: new states, camera, image, panel; keys and clicks.
#include "viewer_window.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "roomgraph/core/error_text.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/rendering/debug_picture.h"
#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/viewer/descriptions.h"
#include "roomgraph/viewer/picking.h"
#include "screenshot.h"

namespace roomgraph {
namespace {

constexpr int kSide_px = 420, kImage_px = 316;  ///< width of the right column, height of the image in it
mrpt::gui::CDisplayWindowGUI_Params antiAliased() {
  mrpt::gui::CDisplayWindowGUI_Params params;
  params.nSamples = 4;
  return params;
}

constexpr int kMostClickMove_px = 4, kSightingParts = 60;
constexpr int kLeastMap = 4;  ///< times the width of the layers' panel: a map that is narrower lies below it

}  // namespace

ViewerWindow::ViewerWindow(const ViewerRequest& request)
    : CDisplayWindowGUI("roomgraph view: " + request.title, static_cast<unsigned>(request.width),
                        static_cast<unsigned>(request.height), antiAliased()),
      request_(request),
      playback_(timeline_, request.replay ? &request.replay->control() : nullptr),
      scene_(*request.database) {
  background_scene = scene_.scene();
  image_viewport_ = background_scene->createViewport("image");
  image_viewport_->setCustomBackgroundColor({0.16f, 0.17f, 0.19f});
  scene_.setVisible(Layer::kProposals, false);
  timeline_.add(request.states);
  bar_.emplace(*this, commands(), request.replay || request.states.size() > 1);
  layers_.emplace(*this, scene_);
  object_.emplace(*this, kSide_px);
  if (request.top) view_ = View::kTop;
  if (request.follow) view_ = View::kFollow;
  playback_.setSpeed(request.speed);
  if (request.record > 0) playback_.seek(request.record);
  playback_.play(!request.paused && request.replay != nullptr);
  addLoopCallback([this] { tick(); });
  addKeyboardCallback(
      [this](int key, int, int action, int modifiers) { return onKey(key, action, modifiers); });
}

Commands ViewerWindow::commands() {
  return {.play = [this] { playback_.play(!playback_.playing()); },
          .back = [this] { playback_.step(false); },
          .forward = [this] { playback_.step(true); },
          .slower = [this] { playback_.slower(); },
          .faster = [this] { playback_.faster(); },
          .top = [this] { fitView(View::kTop); },
          .follow = [this] { fitView(View::kFollow); },
          .orbit = [this] { fitView(View::kFree); },
          .save = [this] { save_ = true; },
          .seek = [this](int record) { playback_.seek(record); }};
}

bool ViewerWindow::onKey(int key, int action, int modifiers) {
  if (action == GLFW_RELEASE || (modifiers & GLFW_MOD_ALT) || bar_->typing()) return false;
  if (key >= GLFW_KEY_1 && key < GLFW_KEY_1 + static_cast<int>(kLayerNames.size())) {
    const auto layer = static_cast<Layer>(key - GLFW_KEY_1);
    scene_.setVisible(layer, !scene_.visible(layer));
    layers_->update();
    return true;
  }
  switch (key) {
    case GLFW_KEY_SPACE:
      playback_.play(!playback_.playing());
      return true;
    case GLFW_KEY_LEFT:
      playback_.step(false);
      return true;
    case GLFW_KEY_RIGHT:
      playback_.step(true);
      return true;
    case GLFW_KEY_HOME:
      playback_.seek(1);
      return true;
    case GLFW_KEY_END:
      playback_.seek(timeline_.empty() ? 1 : timeline_.newest().record);
      return true;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      playback_.faster();
      return true;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      playback_.slower();
      return true;
    case GLFW_KEY_T:
      fitView(View::kTop);
      return true;
    case GLFW_KEY_F:
      fitView(View::kFollow);
      return true;
    case GLFW_KEY_O:
      fitView(View::kFree);
      return true;
    case GLFW_KEY_S:
      save_ = true;
      return true;
    case GLFW_KEY_ESCAPE:
      selected_ = {};
      shown_.reset();
      return true;
    case GLFW_KEY_Q:
      leave();
      return true;
    default:
      return false;
  }
}

void ViewerWindow::tick() {
  const auto now = Clock::now();
  const double elapsed_s = std::chrono::duration<double>(now - last_tick_).count();
  last_tick_ = now;
  if (request_.interrupted()) leave();
  if (request_.exit_after_s > 0 && now - opened_ > std::chrono::duration<double>(request_.exit_after_s)) {
    save_ = save_ || (request_.save_at_end && !leaving_);
    leaving_ = true;
  }
  takeStates();
  playback_.advance(elapsed_s);
  placeParts();
  if (!timeline_.empty()) {
    if (timeline_.shownPointer() != shown_) showState();
    showImage();
    moveCamera();
  }
  showStatus();
}

void ViewerWindow::takeStates() {
  if (!request_.replay) return;
  const bool ended = request_.replay->phase() == LiveReplay::Phase::kEnded;
  auto [states, frame] = request_.replay->mailbox().take();
  timeline_.add(states);
  if (frame) newest_frame_ = std::move(frame);
  if (ended) playback_.replayEnded();
}

void ViewerWindow::showState() {
  shown_ = timeline_.shownPointer();
  scene_.show(shown_, selected_);
  showObject();
}

// The image of the frame that is shown, with what was made of it; without one, the best view of the object.
void ViewerWindow::showImage() {
  cv::Mat picture;
  if (shown_->frame && image_t_ != shown_->frame->t) {
    const double t = shown_->frame->t;
    if (newest_frame_ && newest_frame_->report.t == t) {
      picture = debugPicture(newest_frame_->report, *request_.database);
    } else if (const auto frame = request_.images ? request_.images->find(t) : nullptr) {
      StepReport report = *shown_->frame;
      report.image = frame.get();
      report.frame = frame->id;
      picture = debugPicture(report, *request_.database);
    }
    if (!picture.empty()) image_t_ = t;
  } else if (!shown_->frame || !request_.images) {
    const auto view = request_.views.find(selected_);
    if (selected_ == image_of_ || view == request_.views.end()) return;
    picture = cv::imdecode(std::vector<char>(view->second.begin(), view->second.end()), cv::IMREAD_COLOR);
    image_of_ = selected_;
  }
  if (!picture.empty()) image_viewport_->setImageView(mrpt::img::CImage(picture, mrpt::img::DEEP_COPY));
}

void ViewerWindow::showObject() {
  const double start_t = timeline_.states().front()->t, end_t = timeline_.newest().t;
  const ShownLandmark* object = findLandmark(*shown_, selected_);
  if (object) {
    const auto sightings = timeline_.sightingsOf(selected_);
    object_->show(describeLandmark(*object, sightings, start_t),
                  sightingsOverTime(sightings, start_t, end_t, kSightingParts));
  } else if (selected_.valid()) {
    object_->show({{"#" + std::to_string(selected_.value), {"not known at this moment"}}}, {});
  } else {
    object_->show({{"Click an object", {"to see what is known of it"}}}, {});
  }
}

void ViewerWindow::showStatus() {
  BarStatus status{.playing = playback_.playing(), .speed = describeSpeed(playback_.speed())};
  if (shown_) {
    status.record = shown_->record;
    status.last_record = timeline_.newest().record;
    status.text = describeMoment(*shown_, timeline_.states().front()->t);
  }
  if (request_.replay) {
    using Phase = LiveReplay::Phase;
    const Phase phase = request_.replay->phase();
    const double share = std::max(request_.replay->share(), 0.01);
    if (phase == Phase::kReplaying)
      status.last_record = static_cast<int>(status.last_record / share);
    else if (phase == Phase::kRefining)
      status.text += "; refining with all hindsight …";
    else
      try {
        request_.replay->rethrow();
      } catch (const std::exception& error) {
        status.text = "the replay failed: " + firstLine(error);
      }
  }
  if (!message_.empty()) status.text += "; " + message_;
  bar_->show(status);
}

void ViewerWindow::placeParts() {
  if (placed_for_ == size()) return;
  placed_for_ = size();
  const int width = size().x(), height = size().y();
  const double map_width = std::max(width - kSide_px, 1),
               map_height = std::max(height - ControlBar::kHeight_px, 1);
  background_scene->getViewport()->setViewportPosition(0, 1 - map_height / height, map_width / width,
                                                       map_height / height);
  image_viewport_->setViewportPosition(map_width / width, 1 - static_cast<double>(kImage_px) / height,
                                       static_cast<double>(kSide_px) / width,
                                       static_cast<double>(kImage_px) / height);
  bar_->place(height - ControlBar::kHeight_px, width);
  object_->place(width - kSide_px, kImage_px, std::max(height - kImage_px - ControlBar::kHeight_px, 1));
  performLayout();
  fitted_ = false;
}

OrbitCamera ViewerWindow::camera() const {
  const auto now = m_background_canvas.cameraParams();
  const auto metres = [](float value) { return static_cast<double>(value); };
  return {.target = {metres(now.cameraPointingX), metres(now.cameraPointingY), metres(now.cameraPointingZ)},
          .distance = metres(now.cameraZoomDistance),
          .azimuth = metres(now.cameraAzimuthDeg) * kDegree,
          .elevation = metres(now.cameraElevationDeg) * kDegree,
          .field_of_view = metres(now.cameraFOV) * kDegree,
          .orthographic = !now.cameraIsProjective,
          .width = std::max(size().x() - kSide_px, 1),
          .height = std::max(size().y() - ControlBar::kHeight_px, 1)};
}

void ViewerWindow::setCamera(const OrbitCamera& wanted) {
  mrpt::opengl::CCamera camera_now;
  wanted.applyTo(camera_now);
  auto params = mrpt::gui::CGlCanvasBase::CamaraParams::FromCamera(camera_now);
  params.cameraFOV = static_cast<float>(wanted.field_of_view * kDegreesPerRadian);
  m_background_canvas.setCameraParams(params);
  set_ = camera();
}

void ViewerWindow::fitView(View view) {
  view_ = view;
  fitted_ = false;
}

// Fits the view when it was chosen, when the window has another size, and while the map grows, unless
// somebody moved the camera himself.
void ViewerWindow::moveCamera() {
  const OrbitCamera now = camera();
  if (view_ == View::kFollow) {
    OrbitCamera wanted = behindRobot(shown_->world_from_robot, now.width, now.height);
    if (fitted_) wanted.distance = now.distance, wanted.elevation = now.elevation;
    fitted_ = true;
    return setCamera(wanted);
  }
  const double extent = contentExtent(scene_.map());
  const bool moved = set_ && !(now.target.isApprox(set_->target) && now.distance == set_->distance &&
                               now.azimuth == set_->azimuth && now.elevation == set_->elevation);
  const std::size_t objects = scene_.map().landmarks.size();  // a door stands higher than walls are drawn
  const bool grown = std::abs(extent - fitted_extent_) >= 0.05 * fitted_extent_ || objects > fitted_objects_;
  if (fitted_ && (moved || !grown)) return;
  fitted_ = true;
  fitted_extent_ = extent;
  fitted_objects_ = objects;
  OrbitCamera wanted{.distance = 2 * extent, .width = now.width, .height = now.height};
  wanted.target << contentBounds(scene_.map()).center().head<2>(), 0;
  wanted.orthographic = view_ == View::kTop;
  if (view_ != View::kTop) wanted.azimuth = -65 * kDegree, wanted.elevation = 42 * kDegree;
  const double margin = 0.04 * now.width;
  // From above the corners of the map are the corners of the window.
  const bool beside = view_ == View::kTop && kLeastMap * layers_->right() < now.width;
  const double left = beside ? layers_->right() + margin / 2 : margin;
  wanted.fit(contentPoints(scene_.map()), {left, margin, now.width - margin, now.height - margin});
  background_scene->getViewport()->setViewportClipDistances(0.1f, static_cast<float>(10 * extent + 100));
  setCamera(wanted);
}

bool ViewerWindow::mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) {
  if (CDisplayWindowGUI::mouseButtonEvent(p, button, down, modifiers) && findWidget(p) != this) return true;
  if (button != GLFW_MOUSE_BUTTON_1) return false;
  if (down)
    pressed_at_ = p;
  else if ((p - pressed_at_).cwiseAbs().maxCoeff() <= kMostClickMove_px)
    select(p);
  return false;
}

void ViewerWindow::select(const nanogui::Vector2i& pixel) {
  const OrbitCamera now = camera();
  if (!shown_ || !shown_->landmarks || findWidget(pixel) != this || pixel.x() >= now.width ||
      pixel.y() >= now.height)
    return;
  selected_ = pickLandmark(now.rayThrough(pixel.cast<double>()), *shown_->landmarks,
                           scene_.visible(Layer::kProposals));
  scene_.show(shown_, selected_);
  showObject();
}

void ViewerWindow::drawAll() {
  if (std::exchange(save_, false)) save();
  CDisplayWindowGUI::drawAll();
  if (leaving_) leave();
}

void ViewerWindow::save() {
  const auto file = request_.picture.empty() ? freePicture("view") : std::filesystem::path(request_.picture);
  try {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    drawContents();
    drawWidgets();
    saveBackBuffer(mFBSize.x(), mFBSize.y(), file);
    message_ = "saved " + file.string();
  } catch (const std::exception& error) {
    message_ = firstLine(error);
    if (leaving_) error_ = std::current_exception();
  }
}

void ViewerWindow::leave() {
  setVisible(false);
  nanogui::leave();
}

}  // namespace roomgraph
