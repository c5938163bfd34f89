// SPDX-License-Identifier: BSD-3-Clause
// Panel with all that is known of one object.
#pragma once

#include <nanogui/nanogui.h>

#include <vector>

#include "roomgraph/viewer/descriptions.h"

namespace roomgraph {

class ObjectPanel {
 public:
  /// The screen owns the widgets.
  ObjectPanel(nanogui::Screen& screen, int width);

  /// Blocks of text, and the number of sightings over the time of the run (shares of the largest).
  void show(const std::vector<TextBlock>& blocks, const std::vector<float>& sightings);
  void place(int x, int y, int height);

 private:
  struct Lines {
    nanogui::Label *heading, *text;
  };
  nanogui::Screen& screen_;
  nanogui::Window* window_;
  nanogui::VScrollPanel* scroll_;
  nanogui::Graph* graph_ = nullptr;
  std::vector<Lines> blocks_;
  int width_;
};

}  // namespace roomgraph
