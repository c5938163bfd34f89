// SPDX-License-Identifier: BSD-3-Clause
// Floor as outlines of cells, path, objects, lines of sight, names.
#include "map_drawing.h"

#include <algorithm>
#include <cmath>

#include "labels.h"
#include "roomgraph/rendering/scene_parts.h"
#include "roomgraph/observations/path_length.h"
#include "symbols.h"

namespace roomgraph {
namespace {

constexpr double kMargin_m = 0.12, kOutlineTolerance_m = 0.01;
constexpr double kPathStep_m = 0.03;
constexpr double kPath_pt = 1.1, kLabel_pt = 6.5;

void drawCells(Canvas& canvas, const CSemanticMap& map, bool (*chosen)(float), const palette::TColor& color,
               const PagePlace& place) {
  if (!map.occupancy) return;
  auto rings = simplified(outlinesOf(*map.occupancy, chosen), kOutlineTolerance_m);
  for (auto& ring : rings)
    for (auto& corner : ring) corner = place(corner);
  canvas.area(rings, color);
}

void drawMetres(Canvas& canvas, const CSemanticMap& map, const PagePlace& place) {
  const double step = gridStep(contentExtent(map));
  const Eigen::Vector2d low = place.world.min(), high = place.world.max();
  const Pen pen{palette::kGridLine, 0.4};
  for (double x = std::ceil(low.x() / step) * step; x <= high.x(); x += step)
    canvas.line({place({x, low.y()}), place({x, high.y()})}, pen);
  for (double y = std::ceil(low.y() / step) * step; y <= high.y(); y += step)
    canvas.line({place({low.x(), y}), place({high.x(), y})}, pen);
}

/// The path in pieces without gaps, as when the robot was lost or between two sessions.
std::vector<std::vector<StampedPose>> pathRuns(const CSemanticMap& map) {
  std::vector<std::vector<StampedPose>> runs;
  for (const auto& stamped : map.world_from_robot) {
    const double step = runs.empty()
                            ? kSessionGap_m
                            : (stamped.pose.translation() - runs.back().back().pose.translation()).norm();
    if (step >= kSessionGap_m)
      runs.push_back({stamped});
    else if (step >= kPathStep_m)
      runs.back().push_back(stamped);
  }
  return runs;
}

/// Screen: from light to dark with time. Paper: one colour.
void drawPathRun(Canvas& canvas, const std::vector<StampedPose>& run, double begin, double span,
                 FigureStyle style, const PagePlace& place) {
  const auto at = [&](std::size_t i) { return place(run[i].pose.translation().head<2>()); };
  Polygon2 line{at(0)};
  for (std::size_t i = 1; i < run.size(); ++i) {
    line.push_back(at(i));
    if (style == FigureStyle::kPaper && i + 1 < run.size()) continue;
    const double late = style == FigureStyle::kPaper ? 1 : (run[i].t - begin) / span;
    canvas.line(line, {palette::mix(palette::kPathStart, palette::kPathEnd, late), kPath_pt});
    line = {at(i)};
  }
}

void drawPath(Canvas& canvas, const CSemanticMap& map, FigureStyle style, const PagePlace& place) {
  if (map.world_from_robot.empty()) return;
  const double begin = map.world_from_robot.front().t;
  const double span = std::max(map.world_from_robot.back().t - begin, 1e-9);
  for (const auto& run : pathRuns(map)) drawPathRun(canvas, run, begin, span, style, place);
  const Eigen::Vector2d start = place(map.world_from_robot.front().pose.translation().head<2>());
  canvas.area({circleAt(start, 3)}, palette::kPathEnd);
  canvas.area({circleAt(start, 1.9)}, palette::kFree);
  const Pose3& last = map.world_from_robot.back().pose;
  const double yaw = planarPart(last).yaw;
  const Eigen::Vector2d tip = place(last.translation().head<2>());
  const Eigen::Vector2d ahead(std::cos(yaw), -std::sin(yaw)), aside(-ahead.y(), ahead.x());
  const auto arrow = [&](double size) {
    return Polygon2{tip + 1.2 * size * ahead, tip - 0.9 * size * ahead + 0.85 * size * aside,
                    tip - 0.9 * size * ahead - 0.85 * size * aside};
  };
  canvas.area({arrow(5.4)}, palette::kFree);
  canvas.area({arrow(4.2)}, palette::kPathEnd);
}

void drawObject(Canvas& canvas, const Landmark& landmark, const ObjectDatabase& database, FigureStyle style,
                const PagePlace& place) {
  const Pose2 pose = planarPart(landmark.worldFromObject());
  const Eigen::Rotation2Dd turn(pose.yaw);
  const Eigen::Vector2d centre(pose.x, pose.y);
  drawSymbol(canvas, symbolOf(database, landmark.class_name), landmark.shape, landmark.has_yaw, style,
             [&](const Eigen::Vector2d& at) { return place(Eigen::Vector2d(centre + turn * at)); });
}

/// Lines from the robot to what it measures at this moment.
void drawSight(Canvas& canvas, const MapPicture& picture, const ObjectDatabase& database,
               const PagePlace& place) {
  if (picture.shown.world_from_robot.empty()) return;
  const Eigen::Vector2d robot = place(picture.shown.world_from_robot.back().pose.translation().head<2>());
  for (const auto& landmark : picture.shown.landmarks) {
    const auto& seen = picture.in_sight;
    if (std::find(seen.begin(), seen.end(), landmark.id) == seen.end()) continue;
    const auto color = palette::mix(palette::ofClass(database, landmark.class_name), {0, 0, 0}, 0.25);
    canvas.line({robot, place(landmark.position.head<2>())}, {color, 0.8});
  }
}

std::string nameOf(const Landmark& landmark, ObjectNames names) {
  const std::string number = std::to_string(landmark.id.value);
  return names == ObjectNames::kNumber ? number : inWords(landmark.class_name) + " " + number;
}

Box2 boxOnPage(const Landmark& landmark, const PagePlace& place) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : footprintInWorld(landmark)) box.extend(place(corner.head<2>()));
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

/// Places of all names are chosen before one is drawn: in a film they stay where they are.
void drawNames(Canvas& canvas, const MapPicture& picture, ObjectNames names, const PagePlace& place) {
  const Lettering style{kLabel_pt, palette::kInk, TextAlign::kLeft, 1.3};
  std::vector<Label> labels;
  for (const auto& landmark : picture.whole.landmarks) {
    const std::string text = nameOf(landmark, names);
    labels.push_back({text, boxOnPage(landmark, place), canvas.textWidth(text, style), 0.73 * kLabel_pt, {}});
  }
  const Eigen::Vector2d end = place.corner + place.size();
  placeLabels(labels, {place.corner.x(), place.corner.y(), end.x(), end.y()});
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto same = [&](const Landmark& one) { return one.id == picture.whole.landmarks[i].id; };
    const auto& shown = picture.shown.landmarks;
    if (std::any_of(shown.begin(), shown.end(), same))
      canvas.text({labels[i].place.u_min, labels[i].place.v_max}, labels[i].text, style);
  }
}

}  // namespace

FloorShades shadesOf(FigureStyle style) {
  if (style == FigureStyle::kScreen) return {palette::kUnknown, palette::kFree, palette::kOccupied};
  return {palette::kFree, {238, 240, 242}, {30, 33, 38}};
}

Eigen::AlignedBox2d drawnWorld(const CSemanticMap& map) {
  const auto content = contentBounds(map);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kMargin_m);
  return {Eigen::Vector2d(content.min().head<2>() - margin),
          Eigen::Vector2d(content.max().head<2>() + margin)};
}

void drawMap(Canvas& canvas, const MapPicture& picture, const ObjectDatabase& database, FigureStyle style,
             ObjectNames names, const PagePlace& place) {
  const FloorShades shades = shadesOf(style);
  drawCells(canvas, picture.shown, isFreeCell, shades.free, place);
  if (style == FigureStyle::kScreen) drawMetres(canvas, picture.whole, place);
  drawCells(canvas, picture.shown, isOccupiedCell, shades.wall, place);
  drawPath(canvas, picture.shown, style, place);
  drawSight(canvas, picture, database, place);
  for (const auto& landmark : picture.shown.landmarks) drawObject(canvas, landmark, database, style, place);
  drawNames(canvas, picture, names, place);
}

}  // namespace roomgraph
