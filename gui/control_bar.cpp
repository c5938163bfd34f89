// SPDX-License-Identifier: BSD-3-Clause
// Buttons, slider, record number and status line; check boxes.
#include "control_bar.h"

#include <algorithm>

namespace roomgraph {
namespace {

constexpr int kButton_px = 30, kText_px = 16;

}  // namespace

ControlBar::ControlBar(nanogui::Screen& screen, Commands commands, bool player)
    : commands_(std::move(commands)) {
  window_ = new nanogui::Window(&screen, "");
  window_->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, 8, 6));
  row_ = new nanogui::Widget(window_);
  row_->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Horizontal, nanogui::Alignment::Middle, 0, 6));
  if (player) addPlayer();
  button(0, "Top", "seen from above (T)", commands_.top);
  button(0, "Follow", "behind the robot (F)", commands_.follow);
  button(0, "Orbit", "the whole map, obliquely (O)", commands_.orbit);
  button(ENTYPO_ICON_SAVE, "Save", "picture of the window (S)", commands_.save);
  text_ = new nanogui::Label(window_, " ", "sans", kText_px);
}

nanogui::Button* ControlBar::button(int icon, const std::string& caption, const std::string& help,
                                    const std::function<void()>& pressed) {
  auto* made = new nanogui::Button(row_, caption, icon);
  made->setTooltip(help);
  made->setCallback(pressed);
  made->setFixedHeight(kButton_px);
  return made;
}

void ControlBar::addPlayer() {
  button(ENTYPO_ICON_CONTROLLER_JUMP_TO_START, "", "the beginning (Home)", [this] { commands_.seek(1); });
  button(ENTYPO_ICON_CHEVRON_LEFT, "", "one record back (left)", commands_.back);
  play_ = button(ENTYPO_ICON_CONTROLLER_PLAY, "", "play, pause (space)", commands_.play);
  button(ENTYPO_ICON_CHEVRON_RIGHT, "", "one record on (right)", commands_.forward);
  slider_ = new nanogui::Slider(row_);
  slider_->setFixedHeight(kButton_px);
  slider_->setCallback([this](float) { dragged_ = true; });
  slider_->setFinalCallback([this](float share) {
    dragged_ = false;
    commands_.seek(std::max(1, static_cast<int>(share * static_cast<float>(last_record_))));
  });
  record_ = new nanogui::IntBox<int>(row_, 0);
  record_->setEditable(true);
  record_->setFixedSize({90, kButton_px - 4});
  record_->setTooltip("record; type another and press Enter");
  record_->setCallback([this](int record) { commands_.seek(record); });
  button(ENTYPO_ICON_MINUS, "", "slower (-)", commands_.slower);
  speed_ = new nanogui::Label(row_, "1×", "sans-bold", kText_px);
  speed_->setFixedWidth(40);
  button(ENTYPO_ICON_PLUS, "", "faster (+)", commands_.faster);
}

void ControlBar::show(const BarStatus& status) {
  text_->setCaption(status.text);
  if (!play_) return;
  last_record_ = std::max(1, status.last_record);
  play_->setIcon(status.playing ? ENTYPO_ICON_CONTROLLER_PAUS : ENTYPO_ICON_CONTROLLER_PLAY);
  if (!dragged_) slider_->setValue(static_cast<float>(status.record) / static_cast<float>(last_record_));
  if (!record_->focused()) record_->setValue(status.record);
  speed_->setCaption(status.speed);
}

void ControlBar::place(int y, int width) {
  window_->setPosition({0, y});
  window_->setFixedSize({width, kHeight_px});
  text_->setFixedSize({width - 20, kText_px + 6});
  if (slider_) slider_->setFixedWidth(std::max(80, width - 780));
}

LayerPanel::LayerPanel(nanogui::Screen& screen, LayeredScene& scene)
    : scene_(scene), window_(new nanogui::Window(&screen, "Layers")) {
  window_->setPosition({8, 8});
  window_->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, 8, 4));
  for (std::size_t i = 0; i < kLayerNames.size(); ++i) {
    const std::string caption = std::to_string(i + 1) + " " + std::string(kLayerNames[i]);
    auto* box = new nanogui::CheckBox(window_, caption,
                                      [this, i](bool on) { scene_.setVisible(static_cast<Layer>(i), on); });
    box->setFontSize(kText_px);
    boxes_.push_back(box);
  }
  update();
}

void LayerPanel::update() {
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    boxes_[i]->setChecked(scene_.visible(static_cast<Layer>(i)));
}

}  // namespace roomgraph
