// SPDX-License-Identifier: BSD-3-Clause
// What a viewer's window is asked to show, and the function that shows it.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "roomgraph/observations/object_database.h"
#include "roomgraph/viewer/frame_finder.h"
#include "roomgraph/viewer/live_replay.h"
#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// A run to show, live or finished, and how. What is pointed to outlives the window.
struct ViewerRequest {
  std::string title;
  const ObjectDatabase* database = nullptr;  ///< of the classes' colours
  LiveReplay* replay = nullptr;              ///< null: all states are there
  ViewStates states;                         ///< of a finished run or map
  FrameFinder* images = nullptr;             ///< null: no recording is known
  std::map<LandmarkId, std::string> views;   ///< best picture of each landmark: JPEG

  bool paused = false, follow = false, top = false;
  double speed = 1;     ///< seconds of the recording in a second; 0: as fast as possible
  int record = 0;       ///< to be shown first; 0: the beginning of a replay, the end of a finished run
  std::string picture;  ///< PNG for what is saved; empty: view_1.png, view_2.png …
  bool save_at_end = false;
  double exit_after_s = 0;                                   ///< closes the window by itself; 0: never
  int width = 1360, height = 840;                            ///< of the window, px
  std::function<bool()> interrupted = [] { return false; };  ///< true: close the window
};

/// Shows a window until it is closed. Throws RunError: there is no display, or a picture cannot be written.
using ShowViewer = void(const ViewerRequest& request);
/// The module of the window, which alone needs a GUI library, and the name under which it has that function.
inline constexpr const char* kShowViewer = "roomgraph_show_viewer";
inline constexpr const char* kViewerModule = "roomgraph_gui.so";

}  // namespace roomgraph
