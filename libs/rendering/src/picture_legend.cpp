// SPDX-License-Identifier: BSD-3-Clause
// Entries measured, broken into rows, and drawn.
#include "picture_legend.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "class_counts.h"
#include "glyphs.h"
#include "overlay.h"
#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {
namespace {

constexpr double kMargin = 3, kSwatch = 1.3, kPathSwatch = 3, kAfterSwatch = 0.7, kAfterWord = 2, kGroup = 1.2;  // all in units
constexpr double kMostOfHeight = 0.5, kBesideRows = 20;  // title, scale and some map, in units

TextStyle wordStyle(double unit_px) {
  return {0.9 * unit_px, palette::kInk, 2};
}

double swatchWidth(const PictureLegendEntry& entry, double unit_px) {
  return (entry.is_path ? kPathSwatch : kSwatch) * unit_px;
}

double widthOf(const PictureLegendEntry& entry, double unit_px) {
  return swatchWidth(entry, unit_px) + kAfterSwatch * unit_px + textWidth(entry.longest, wordStyle(unit_px));
}

std::vector<PictureLegendEntry> entriesOf(const MapPicture& picture, const ObjectDatabase& database) {
  std::vector<PictureLegendEntry> out;
  for (const auto& [name, count] : classCounts(picture)) {
    const auto color = palette::ofClass(database, name);
    out.push_back({withCount(name, count.shown), palette::mix(color, palette::kFree, 0.25),
                   palette::mix(color, {0, 0, 0}, 0.25)});
    out.back().longest = withCount(name, count.whole);
  }
  if (picture.whole.occupancy) {
    out.push_back({"obstacle", palette::kOccupied, palette::kOccupied, true});
    out.push_back({"free", palette::kFree, palette::kGridLine});
  }
  if (!picture.whole.world_from_robot.empty()) out.push_back({"path, start to end", {}, {}, true, true});
  for (auto& entry : out)
    if (entry.longest.empty()) entry.longest = entry.text;
  return out;
}

// Rows counted from the highest.
void breakIntoRows(std::vector<PictureLegendEntry>& entries, double right_px, double unit_px) {
  double u = kMargin * unit_px;
  std::size_t row = 0;
  for (auto& entry : entries) {
    const double width = widthOf(entry, unit_px);
    if (entry.begins_group && u > kMargin * unit_px) u += kGroup * unit_px;
    if (u > kMargin * unit_px && u + width > right_px) {
      ++row;
      u = kMargin * unit_px;
    }
    entry.u = u;
    entry.row = row;
    u += width + kAfterWord * unit_px;
  }
}

}  // namespace

PictureLegend::PictureLegend(const MapPicture& picture, const ObjectDatabase& database, const cv::Size& size, double unit)
    : unit_px(unit), entries(entriesOf(picture, database)) {
  if (entries.empty()) return;
  const double right_px = size.width - 2 * kMargin * unit_px - roomOfScale(picture.whole, size, unit_px);
  const double room_px = std::min(kMostOfHeight * size.height, size.height - kBesideRows * unit_px);
  const auto most = static_cast<std::size_t>(std::max(1.0, room_px / (kLegendRow * unit_px)));
  const std::size_t all = entries.size();
  breakIntoRows(entries, right_px, unit_px);
  while (entries.back().row >= most) {
    entries.resize(entries.size() - 2);
    entries.push_back({"and " + std::to_string(all - entries.size()) + " more", palette::kFree, palette::kGridLine});
    entries.back().longest = entries.back().text;
    breakIntoRows(entries, right_px, unit_px);
  }
  const std::size_t lowest = entries.back().row;
  for (auto& entry : entries) entry.row = lowest - entry.row;
}

void PictureLegend::draw(cv::Mat& image) const {
  for (const auto& entry : entries) {
    const double v = image.rows - (2.6 + kLegendRow * static_cast<double>(entry.row)) * unit_px;
    const double end = entry.u + swatchWidth(entry, unit_px);
    if (entry.is_path) {
      const int steps = 24;
      for (int i = 0; i < steps; ++i)
        fillBox(image,
                {entry.u + kPathSwatch * unit_px * i / steps, v - 0.65 * unit_px,
                 entry.u + kPathSwatch * unit_px * (i + 1) / steps, v - 0.3 * unit_px},
                palette::mix(palette::kPathStart, palette::kPathEnd, static_cast<double>(i) / (steps - 1)));
    } else {
      fillBox(image, {entry.u, v - 1.15 * unit_px, end, v + 0.15 * unit_px}, entry.rim);
      fillBox(image, {entry.u + 1, v - 1.15 * unit_px + 1, end - 1, v + 0.15 * unit_px - 1}, entry.color);
    }
    drawText(image, entry.text, {end + kAfterSwatch * unit_px, v}, wordStyle(unit_px));
  }
}

}  // namespace roomgraph
