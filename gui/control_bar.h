// SPDX-License-Identifier: BSD-3-Clause
// Bar with the controls of a player and of the camera, and the list of layers.
#pragma once

#include <nanogui/nanogui.h>

#include <functional>
#include <string>

#include "roomgraph/viewer/layered_scene.h"

namespace roomgraph {

/// What the buttons do.
struct Commands {
  std::function<void()> play, back, forward, slower, faster, top, follow, orbit, save;
  std::function<void(int)> seek;  ///< to a record
};

/// What the bar tells.
struct BarStatus {
  bool playing = false;
  int record = 0, last_record = 0;  ///< shown; of the run, perhaps estimated
  std::string speed, text;
};

class ControlBar {
 public:
  static constexpr int kHeight_px = 84;

  /// The screen owns the widgets. `player`: whether there is anything to play.
  ControlBar(nanogui::Screen& screen, Commands commands, bool player);
  void show(const BarStatus& status);
  void place(int y, int width);
  /// Whether somebody types a number: keys mean nothing else then.
  bool typing() const { return record_ && record_->focused(); }

 private:
  nanogui::Button* button(int icon, const std::string& caption, const std::string& help,
                          const std::function<void()>& pressed);
  void addPlayer();

  Commands commands_;
  nanogui::Window* window_;
  nanogui::Widget* row_;
  nanogui::Button* play_ = nullptr;
  nanogui::Slider* slider_ = nullptr;
  nanogui::IntBox<int>* record_ = nullptr;
  nanogui::Label *speed_ = nullptr, *text_;
  int last_record_ = 1;
  bool dragged_ = false;  ///< the slider, by the mouse
};

/// A check box for each layer.
class LayerPanel {
 public:
  LayerPanel(nanogui::Screen& screen, LayeredScene& scene);
  /// Sets the boxes to what the scene shows.
  void update();
  /// Its right side, px.
  int right() const { return window_->position().x() + window_->width(); }

 private:
  LayeredScene& scene_;
  nanogui::Window* window_;
  std::vector<nanogui::CheckBox*> boxes_;
};

}  // namespace roomgraph
