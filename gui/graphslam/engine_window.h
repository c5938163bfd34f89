// SPDX-License-Identifier: BSD-3-Clause
// The window of an engine, as MRPT's graphslam-engine opens it.
#pragma once

#include <mrpt/gui/CDisplayWindow3D.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "roomgraph/core/errors.h"
#include "roomgraph/graphslam/engine_run.h"

namespace roomgraph {

/// From now on the process ends without the destructors of global objects: MRPT (2.5) frees the requests to its window
/// thread there while that thread still takes some, and one exit in twelve was a crash.
inline void leaveWindowThreadAlone() {
  const auto end = [](int status, void*) {
    std::cout.flush();
    std::fflush(nullptr);
    _exit(status);
  };
  static const bool once = on_exit(end, nullptr) == 0;
  if (!once) throw RunError("no window: the end of the process cannot be arranged");
}

/// Nothing of a window's scene is drawn and no key arrives meanwhile: MRPT (2.5) sets its texts and asks for keys without
/// any lock, beside the thread that draws the texts and notes the keys, and one run in thirty was a crash.
class SceneLock {
 public:
  /// Null: there is no window.
  explicit SceneLock(mrpt::gui::CDisplayWindow3D* window) : window_(window) {
    if (window_) window_->get3DSceneAndLock();
  }
  ~SceneLock() {
    if (window_) window_->unlockAccess3DScene();
  }
  SceneLock(const SceneLock&) = delete;
  SceneLock& operator=(const SceneLock&) = delete;

 private:
  mrpt::gui::CDisplayWindow3D* window_;
};

/// Notes keys under the lock of the scene. It keeps the key that pauses for itself: MRPT's engine waits within a step,
/// where the scene is locked.
class KeyObserver : public mrpt::graphslam::CWindowObserver {
 public:
  void setWindow(mrpt::gui::CDisplayWindow3D* window) { window_ = window; }
  bool paused() const { return paused_; }

 protected:
  void OnEvent(const mrpt::system::mrptEvent& event) override {
    const auto* key = dynamic_cast<const mrpt::gui::mrptEventWindowChar*>(&event);
    if (key && (key->char_code == 'p' || key->char_code == 'P')) {
      paused_ = !paused_;
      return;
    }
    const SceneLock lock(key ? window_.load() : nullptr);
    mrpt::graphslam::CWindowObserver::OnEvent(event);
  }

 private:
  std::atomic<mrpt::gui::CDisplayWindow3D*> window_ = nullptr;
  std::atomic<bool> paused_ = false;
};

/// A window with its observer, and the manager by which the engine and its parts know it.
class EngineWindow {
 public:
  /// Throws RunError when there is no display.
  explicit EngineWindow(const std::string& title) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
      throw RunError("no window: there is no display (DISPLAY is not set); without --window none is needed");
    leaveWindowThreadAlone();
    window_ = std::make_unique<mrpt::gui::CDisplayWindow3D>(title, 1000, 750);
    observer_.observeBegin(*window_);
    const auto& scene = window_->get3DSceneAndLock();
    observer_.observeBegin(*scene->getViewport("main"));
    window_->unlockAccess3DScene();
    observer_.setWindow(window_.get());
    manager_.setCDisplayWindow3DPtr(window_.get());
    manager_.setWindowObserverPtr(&observer_);
  }

  mrpt::graphslam::CWindowManager* manager() { return &manager_; }
  mrpt::gui::CDisplayWindow3D* display() { return window_.get(); }

  /// While it is paused by its key, and until `go_on()` says no; that is asked ten times a second.
  void waitWhilePaused(const std::function<bool()>& go_on) {
    if (!observer_.paused()) return;
    tell("paused: press P to go on");
    while (observer_.paused() && window_->isOpen() && go_on()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    tell("");
  }

  /// Until it is closed, `interrupted()`, or for so many seconds (negative: for ever).
  void wait(double seconds, const std::function<bool()>& interrupted) {
    const auto start = std::chrono::steady_clock::now();
    const auto over = [&] {
      const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
      return seconds >= 0 && waited.count() >= seconds;
    };
    while (window_->isOpen() && !interrupted() && !over()) {
      window_->forceRepaint();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

 private:
  static constexpr std::size_t kTextOfPause = 1000;  // the engine's and its parts' are below

  void tell(const std::string& text) {
    {
      const SceneLock lock(window_.get());
      window_->addTextMessage(0.3, 0.8, text, kTextOfPause);
    }
    window_->forceRepaint();
  }

  KeyObserver observer_;
  std::unique_ptr<mrpt::gui::CDisplayWindow3D> window_;
  mrpt::graphslam::CWindowManager manager_;
};

}  // namespace roomgraph
