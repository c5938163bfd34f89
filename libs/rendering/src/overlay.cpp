// SPDX-License-Identifier: BSD-3-Clause
// Layout and drawing of labels, title, legend and scale.
#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "glyphs.h"
#include "labels.h"
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

/// Filled rectangle with sub-pixel edges.
void fill(cv::Mat& image, const Box2& box, const palette::TColor& color) {
  const auto fixed = [](double value) { return static_cast<int>(std::lround(value * 16)); };
  const cv::Point corners[4] = {{fixed(box.u_min), fixed(box.v_min)},
                                {fixed(box.u_max), fixed(box.v_min)},
                                {fixed(box.u_max), fixed(box.v_max)},
                                {fixed(box.u_min), fixed(box.v_max)}};
  cv::fillConvexPoly(image, corners, 4, toScalar(color), cv::LINE_AA, 4);
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
                const SceneView& view) {
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
                       mapArea(options).v_max + margin});
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

/// One row at the bottom, filled from the left.
class Legend {
 public:
  Legend(cv::Mat& image, double unit_px)
      : image_(image), unit_(unit_px), u_(3 * unit_px), v_(image.rows - 2.6 * unit_px) {}
  void swatch(const palette::TColor& color, const palette::TColor& rim, const std::string& text) {
    fill(image_, {u_, v_ - 1.15 * unit_, u_ + 1.3 * unit_, v_ + 0.15 * unit_}, rim);
    fill(image_, {u_ + 1, v_ - 1.15 * unit_ + 1, u_ + 1.3 * unit_ - 1, v_ + 0.15 * unit_ - 1}, color);
    name(u_ + 1.3 * unit_, text);
  }
  void path(const std::string& text) {
    const int steps = 24;
    for (int i = 0; i < steps; ++i)
      fill(
          image_,
          {u_ + 3 * unit_ * i / steps, v_ - 0.65 * unit_, u_ + 3 * unit_ * (i + 1) / steps, v_ - 0.3 * unit_},
          palette::mix(palette::kPathStart, palette::kPathEnd, static_cast<double>(i) / (steps - 1)));
    name(u_ + 3 * unit_, text);
  }
  void gap() { u_ += 1.2 * unit_; }

 private:
  void name(double from, const std::string& text) {
    const TextStyle style{0.9 * unit_, palette::kInk, 2};
    drawText(image_, text, {from + 0.7 * unit_, v_}, style);
    u_ = from + 0.7 * unit_ + textWidth(text, style) + 2 * unit_;
  }
  cv::Mat& image_;
  double unit_, u_, v_;
};

void drawLegend(cv::Mat& image, const MapPicture& picture, const ObjectDatabase& database,
                const SnapshotOptions& options) {
  Legend legend(image, unit(options));
  std::map<std::string, int> counts;
  for (const auto& landmark : picture.whole.landmarks) counts[landmark.class_name] = 0;
  for (const auto& landmark : picture.shown.landmarks) ++counts[landmark.class_name];
  for (const auto& [name, count] : counts) {
    const auto color = palette::ofClass(database, name);
    legend.swatch(palette::mix(color, palette::kFree, 0.25), palette::mix(color, {0, 0, 0}, 0.25),
                  inWords(name) + " (" + std::to_string(count) + ")");
  }
  if (!counts.empty()) legend.gap();
  if (picture.whole.occupancy) {
    legend.swatch(palette::kOccupied, palette::kOccupied, "obstacle");
    legend.swatch(palette::kFree, palette::kGridLine, "free");
    legend.gap();
  }
  if (!picture.whole.world_from_robot.empty()) legend.path("path, start to end");
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
  fill(image, {right - length, v - 0.15 * u, right, v + 0.1 * u}, palette::kInk);
  for (const double end : {right - length, right - 0.2 * u})
    fill(image, {end, v - 0.7 * u, end + 0.2 * u, v + 0.1 * u}, palette::kInk);
  text << step << " m";
  drawText(image, text.str(), {right - length / 2 - textWidth(text.str(), style) / 2, v - 0.9 * u}, style);
}

}  // namespace

std::string factsOf(const MapPicture& picture) {
  const auto& path = picture.shown.world_from_robot;
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].pose.translation() - path[i - 1].pose.translation()).norm();
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

Box2 mapArea(const SnapshotOptions& options) {
  const double u = unit(options);
  return {3 * u, (options.title.empty() ? 3 : 8) * u, options.width - 3 * u, options.height - 6 * u};
}

void drawOverlay(cv::Mat& image, const MapPicture& picture, const ObjectDatabase& database,
                 const SnapshotOptions& options, const SceneView& view) {
  drawLabels(image, picture, options, view);
  drawTitle(image, picture, options);
  drawLegend(image, picture, database, options);
  drawScale(image, picture.whole, options, view);
}

}  // namespace roomgraph
