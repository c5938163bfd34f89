// SPDX-License-Identifier: BSD-3-Clause
// Labels and a curve that are filled anew for every object.
#include "object_panel.h"

#include <algorithm>

namespace roomgraph {
namespace {

constexpr std::size_t kMostBlocks = 6;
constexpr int kMargin = 8, kHeading_px = 17, kText_px = 15, kScrollBar_px = 12, kTitle_px = 30;

}  // namespace

ObjectPanel::ObjectPanel(nanogui::Screen& screen, int width) : screen_(screen), width_(width) {
  window_ = new nanogui::Window(&screen, "Object");
  window_->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical));
  scroll_ = new nanogui::VScrollPanel(window_);
  auto* list = new nanogui::Widget(scroll_);
  list->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, kMargin, 2));
  const int inner = width - 2 * kMargin - kScrollBar_px;
  for (std::size_t i = 0; i < kMostBlocks; ++i) {
    auto* heading = new nanogui::Label(list, "", "sans-bold", kHeading_px);
    auto* text = new nanogui::Label(list, "", "sans", kText_px);
    for (auto* label : {heading, text}) label->setFixedWidth(inner);
    blocks_.push_back({heading, text});
    if (i > 0) continue;  // the curve comes after the first block
    graph_ = new nanogui::Graph(list, "sightings over time");
    graph_->setFixedSize({inner, 50});
    graph_->setForegroundColor(nanogui::Color(160, 130, 230, 255));
  }
  show({{"Click an object", {"to see what is known of it"}}}, {});
}

void ObjectPanel::show(const std::vector<TextBlock>& blocks, const std::vector<float>& sightings) {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool used = i < blocks.size();
    std::string text;
    if (used)
      for (const auto& line : blocks[i].lines) text += (text.empty() ? "" : "\n") + line;
    blocks_[i].heading->setCaption(used ? blocks[i].heading : "");
    blocks_[i].text->setCaption(text);
    blocks_[i].heading->setVisible(used);
    blocks_[i].text->setVisible(used && !text.empty());
  }
  graph_->setVisible(!sightings.empty());
  graph_->setValues(Eigen::Map<const Eigen::VectorXf>(sightings.data(), static_cast<long>(sightings.size())));
  screen_.performLayout();
}

void ObjectPanel::place(int x, int y, int height) {
  window_->setPosition({x, y});
  window_->setFixedSize({width_, height});
  scroll_->setFixedSize({width_, std::max(height - kTitle_px, 1)});
}

}  // namespace roomgraph
