// SPDX-License-Identifier: BSD-3-Clause
// The window of an engine, as MRPT's graphslam-engine opens it.
#pragma once

#include <unistd.h>

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
    manager_.setCDisplayWindow3DPtr(window_.get());
    manager_.setWindowObserverPtr(&observer_);
  }

  mrpt::graphslam::CWindowManager* manager() { return &manager_; }

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
  mrpt::graphslam::CWindowObserver observer_;
  std::unique_ptr<mrpt::gui::CDisplayWindow3D> window_;
  mrpt::graphslam::CWindowManager manager_;
};

}  // namespace roomgraph
