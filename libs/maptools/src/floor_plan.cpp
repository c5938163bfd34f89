// SPDX-License-Identifier: BSD-3-Clause
// Floor plan with objects and path, to scale, in SVG.
#include "drawing.h"
#include "exporters.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

void drawObject(const Landmark& landmark, const std::string& color, SvgDrawing& drawing) {
  const std::string title = landmark.class_name + " " + std::to_string(landmark.id.value) + ", existence " +
                            decimals(landmark.existence, 2);
  drawing.polygon(
      footprintOf(landmark),
      "fill=\"" + color + "\" stroke=\"" + color + "\" data-id=\"" + std::to_string(landmark.id.value) + "\"",
      title);
  if (!landmark.has_yaw || landmark.shape.kind == ShapeKind::kPlanar) return;
  const Eigen::Vector2d at = landmark.position.head<2>();
  const Eigen::Vector2d front(std::cos(landmark.yaw), std::sin(landmark.yaw));
  drawing.polyline({at, at + landmark.shape.depth / 2 * front}, "stroke=\"" + color + "\"");
}

}  // namespace

std::string svgText(const CSemanticMap& map, const ObjectDatabase& database, double scale) {
  SvgDrawing drawing(drawingBounds(map), scale);
  drawFloor(map, drawing);
  drawing.beginGroup("path", "stroke=\"#5c2da0\" stroke-width=\"0.03\" stroke-opacity=\"0.6\"");
  for (const auto& piece : pathPieces(map)) drawing.polyline(piece, "");
  drawing.endGroup();
  drawing.beginGroup("objects", "fill-opacity=\"0.45\" stroke-width=\"0.03\"");
  for (const auto& landmark : map.landmarks)
    drawObject(landmark, colorOf(database, landmark.class_name), drawing);
  drawing.endGroup();
  drawing.beginGroup("labels", "fill=\"#262e3a\"");
  for (const auto& landmark : map.landmarks)
    drawing.text(landmark.position.head<2>() - Eigen::Vector2d(0, 0.04), 0.12,
                 landmark.class_name + " " + std::to_string(landmark.id.value));
  drawing.endGroup();
  drawing.scaleBar();
  return drawing.finished();
}

}  // namespace roomgraph
