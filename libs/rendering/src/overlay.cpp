// SPDX-License-Identifier: BSD-3-Clause
// Layout and drawing of labels, title, legend and scale.
#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "glyphs.h"
#include "labels.h"
#include "picture_legend.h"
#include "roomgraph/observations/path_length.h"
#include "roomgraph/rendering/scene_parts.h"

namespace roomgraph {
namespace {

/// All sizes follow from one: the height of a capital letter, px.
double unit(const SnapshotOptions& options) {
  return std::clamp(std::min(options.width, options.height) / 96.0, 6.0, 24.0);
}

cv::Scalar toScalar(const palette::TColor& color) {
  return {color.B * 1.0, color.G * 1.0, color.R * 1.0};
}

Box2 imageBox(const Landmark& landmark, const SceneView& view) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : footprintInWorld(landmark)) {
    for (const double height : {0.0, landmark.shape.height}) {
      const auto pixel = view.project(corner + Eigen::Vector3d(0, 0, height));
      if (!pixel) return {};
      box.extend(*pixel);
    }
  }
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

bool has(const CSemanticMap& map, LandmarkId id) {
  return std::any_of(map.landmarks.begin(), map.landmarks.end(),
                     [id](const Landmark& landmark) { return landmark.id == id; });
}

void drawLabels(cv::Mat& image, const MapPicture& picture, const SnapshotOptions& options,
                const SceneView& view, const Box2& area) {
  const TextStyle style{unit(options) * 0.9, palette::kInk, 2.2};
  const Box2 frame{0, 0, static_cast<double>(image.cols), static_cast<double>(image.rows)};
  std::vector<Label> labels;
  std::vector<LandmarkId> ids;
  for (const auto& landmark : picture.whole.landmarks) {
    const Box2 object = imageBox(landmark, view);
    if (object.empty() || !frame.contains(object.center().x(), object.center().y()) ||
        object.width() > image.cols / 2.0)
      continue;
    const std::string text = inWords(landmark.class_name) + " " + std::to_string(landmark.id.value);
    labels.push_back({text, object, textWidth(text, style), style.cap_height_px, {}});
    ids.push_back(landmark.id);
  }
  const double margin = unit(options);
  placeLabels(labels, {margin, margin * (options.title.empty() ? 1 : 4.5), image.cols - margin,
                       area.v_max + margin});
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (has(picture.shown, ids[i]))
      drawText(image, labels[i].text, {labels[i].place.u_min, labels[i].place.v_max}, style);
}

void drawTitle(cv::Mat& image, const MapPicture& picture, const SnapshotOptions& options) {
  if (options.title.empty()) return;
  const double u = unit(options);
  drawText(image, options.title, {3 * u, 4 * u}, {1.5 * u, palette::kInk, 2});
  drawText(image, factsOf(picture), {3 * u, 6.2 * u}, {0.9 * u, palette::kFaintInk, 2});
}

void drawScale(cv::Mat& image, const CSemanticMap& map, const SnapshotOptions& options,
               const SceneView& view) {
  const double u = unit(options), right = image.cols - 3 * u, v = image.rows - 2.6 * u;
  const double step = gridStep(contentExtent(map));
  std::ostringstream text;
  const TextStyle style{0.9 * u, palette::kInk, 2};
  if (!view.orthographic()) {
    text << "grid " << step << " m";
    drawText(image, text.str(), {right - textWidth(text.str(), style), v}, style);
    return;
  }
  const double length = step * view.pixelsPerMeter();
  fillBox(image, {right - length, v - 0.15 * u, right, v + 0.1 * u}, palette::kInk);
  for (const double end : {right - length, right - 0.2 * u})
    fillBox(image, {end, v - 0.7 * u, end + 0.2 * u, v + 0.1 * u}, palette::kInk);
  text << step << " m";
  drawText(image, text.str(), {right - length / 2 - textWidth(text.str(), style) / 2, v - 0.9 * u}, style);
}

}  // namespace

void fillBox(cv::Mat& image, const Box2& box, const palette::TColor& color) {
  const auto fixed = [](double value) { return static_cast<int>(std::lround(value * 16)); };
  const cv::Point corners[4] = {{fixed(box.u_min), fixed(box.v_min)},
                                {fixed(box.u_max), fixed(box.v_min)},
                                {fixed(box.u_max), fixed(box.v_max)},
                                {fixed(box.u_min), fixed(box.v_max)}};
  cv::fillConvexPoly(image, corners, 4, toScalar(color), cv::LINE_AA, 4);
}

// Nothing of the map is wider than its larger side, and that fits into the picture.
double roomOfScale(const CSemanticMap& map, const cv::Size& size, double unit_px) {
  const double extent = contentExtent(map);
  const double bar_px = extent > 0 ? gridStep(extent) / extent * std::max(size.width, size.height) : 0;
  return std::clamp(bar_px, 8 * unit_px, std::max(8 * unit_px, size.width / 2.0));
}

std::string factsOf(const MapPicture& picture) {
  const double length = pathLength(picture.shown.world_from_robot);
  const Eigen::Vector3d size = contentBounds(picture.whole).sizes();
  const std::size_t objects = picture.shown.landmarks.size();
  std::ostringstream facts;
  facts.setf(std::ios::fixed);
  facts.precision(1);
  facts << size.x() << " x " << size.y() << " m";
  if (!picture.whole.landmarks.empty()) facts << ",  " << objects << (objects == 1 ? " object" : " objects");
  if (length > 0) facts << ",  path " << length << " m";
  return facts.str() + picture.note;
}

Box2 mapArea(const SnapshotOptions& options, std::size_t legend_rows) {
  const double u = unit(options), above_first = kLegendRow * static_cast<double>(legend_rows - 1);
  return {3 * u, (options.title.empty() ? 3 : 8) * u, options.width - 3 * u, options.height - (6 + above_first) * u};
}

Box2 mapArea(const MapPicture& picture, const ObjectDatabase& database, const SnapshotOptions& options) {
  const PictureLegend legend(picture, database, {options.width, options.height}, unit(options));
  return mapArea(options, legend.rows());
}

void drawOverlay(cv::Mat& image, const MapPicture& picture, const ObjectDatabase& database,
                 const SnapshotOptions& options, const SceneView& view) {
  const PictureLegend legend(picture, database, image.size(), unit(options));
  drawLabels(image, picture, options, view, mapArea(options, legend.rows()));
  drawTitle(image, picture, options);
  legend.draw(image);
  drawScale(image, picture.whole, options, view);
}

}  // namespace roomgraph
