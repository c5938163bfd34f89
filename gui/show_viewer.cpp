// SPDX-License-Identifier: BSD-3-Clause
// Entry of the module: display, main loop, end.
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>

#include "roomgraph/core/errors.h"
#include "viewer_window.h"

namespace roomgraph {
namespace {

constexpr int kIdle_ms = 15, kRepaint_ms = 30;

[[noreturn]] void failWithoutDisplay(const std::string& why) {
  throw RunError("no window: " + why +
                 "; pictures and pages need no display: 'roomgraph snapshot MAP.rgmap -o X.png', "
                 "'roomgraph report OUT'");
}

/// The libraries below print what they also report: one line is enough.
class Silence {
 public:
  Silence() : before_(std::cerr.rdbuf(swallowed_.rdbuf())) {}
  ~Silence() { std::cerr.rdbuf(before_); }

 private:
  std::ostringstream swallowed_;
  std::streambuf* before_;
};

std::unique_ptr<ViewerWindow> open(const ViewerRequest& request) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
    failWithoutDisplay("there is no display (DISPLAY is not set)");
  const Silence silence;
  try {
    nanogui::init();
    return std::make_unique<ViewerWindow>(request);
  } catch (const std::exception&) {
    const char* display = std::getenv("DISPLAY");
    failWithoutDisplay("display '" + std::string(display ? display : "") +
                       "' cannot be opened, or has no OpenGL 3.3");
  }
}

void show(const ViewerRequest& request) {
  const auto window = open(request);
  window->performLayout();
  window->drawAll();
  window->setVisible(true);
  nanogui::mainloop(kIdle_ms, kRepaint_ms);
  window->rethrow();
}

}  // namespace
}  // namespace roomgraph

extern "C" __attribute__((visibility("default"))) void roomgraph_show_viewer(
    const roomgraph::ViewerRequest& request) {
  roomgraph::show(request);
  nanogui::shutdown();
}
