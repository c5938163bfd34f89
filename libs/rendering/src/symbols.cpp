// SPDX-License-Identifier: BSD-3-Clause
// Footprints, stars, backs and arms, dashes, hatching.
#include "symbols.h"

#include <Eigen/Geometry>
#include <cmath>

namespace roomgraph {
namespace {

using OnPage = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

constexpr double kOutline_pt = 0.8, kDetail_pt = 0.55, kHatchStep_pt = 3.2;
constexpr double kDoorWidth_pt = 1.9, kDoorRim_pt = 3.4;
constexpr int kHatchings = 3;  ///< /, \ and both

Polygon2 mapped(const Polygon2& points, const OnPage& on_page) {
  Polygon2 out;
  for (const auto& point : points) out.push_back(on_page(point));
  return out;
}

palette::TColor darkOf(const palette::TColor& color) {
  return palette::mix(color, {0, 0, 0}, 0.35);
}

/// Lines at 45 degrees on the page, inside the polygon.
void hatch(Canvas& canvas, const Polygon2& corners, bool rising, const palette::TColor& color) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : corners) box.extend(corner);
  const double height = box.sizes().y(), step = kHatchStep_pt * std::sqrt(2.0);
  canvas.clip(corners);
  for (double x = box.min().x() - height; x < box.max().x(); x += step) {
    const Eigen::Vector2d low(x, box.max().y()), high(x + height, box.min().y());
    const Eigen::Vector2d mirrored_low(x, box.min().y()), mirrored_high(x + height, box.max().y());
    canvas.line(rising ? Polygon2{low, high} : Polygon2{mirrored_low, mirrored_high}, {color, kDetail_pt});
  }
  canvas.release();
}

/// The base of a swivel chair: five feet around a column.
void drawStar(Canvas& canvas, double radius, const palette::TColor& color, const OnPage& on_page) {
  for (int i = 0; i < 5; ++i) {
    const double angle = 2 * M_PI * i / 5;
    const Eigen::Vector2d foot = 0.72 * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    canvas.line({on_page({0, 0}), on_page(foot)}, {color, kDetail_pt});
  }
  canvas.area({mapped(circleAt({0, 0}, 0.14 * radius, 16), on_page)}, color);
}

/// The seat within back and arms.
void drawSeat(Canvas& canvas, const ObjectShape& shape, const palette::TColor& color, const OnPage& on_page) {
  const double back = -shape.depth / 2 + 0.26 * shape.depth, front = shape.depth / 2;
  const double arm = shape.width / 2 - std::min(0.13 * shape.width, 0.26 * shape.depth);
  canvas.line(mapped({{front, arm}, {back, arm}, {back, -arm}, {front, -arm}}, on_page), {color, kDetail_pt});
}

/// Dashed, on a white rim that keeps it off the wall.
void drawDoor(Canvas& canvas, const ObjectShape& shape, const palette::TColor& color, const OnPage& on_page) {
  const Polygon2 leaf = mapped({{0, shape.width / 2}, {0, -shape.width / 2}}, on_page);
  canvas.line(leaf, {palette::kFree, kDoorRim_pt});
  canvas.line(leaf, {color, kDoorWidth_pt, {4, 1.8}});
}

void drawFront(Canvas& canvas, const ObjectShape& shape, const palette::TColor& color,
               const OnPage& on_page) {
  const Eigen::Vector2d at = on_page({shape.depth / 2, 0});
  const Eigen::Vector2d ahead = (on_page({shape.depth / 2 + 1, 0}) - at).normalized(),
                        aside(-ahead.y(), ahead.x());
  canvas.area({{at + 5 * ahead, at + 1.3 * ahead + 2.4 * aside, at + 1.3 * ahead - 2.4 * aside}}, color);
}

void drawPlainly(Canvas& canvas, const Symbol& symbol, const ObjectShape& shape, bool has_yaw,
                 const OnPage& on_page) {
  const auto edge = palette::mix(symbol.color, {0, 0, 0}, 0.25);
  const Polygon2 corners = mapped(footprint(shape, 48), on_page);
  canvas.area({corners}, palette::withAlpha(symbol.color, 190));
  canvas.line(corners, {edge, kOutline_pt}, true);
  if (has_yaw) drawFront(canvas, shape, edge, on_page);
}

}  // namespace

Symbol symbolOf(const ObjectDatabase& database, const std::string& class_name) {
  const ObjectModel* model = database.find(class_name);
  Symbol symbol{palette::ofClass(database, class_name), model ? 0 : kHatchings};
  for (const auto& other : database.models()) {
    if (&other == model) break;
    if (model && other.landmark && other.shape == model->shape) ++symbol.variant;
  }
  return symbol;
}

void drawSymbol(Canvas& canvas, const Symbol& symbol, const ObjectShape& shape, bool has_yaw,
                FigureStyle style, const OnPage& on_page) {
  if (style == FigureStyle::kScreen) return drawPlainly(canvas, symbol, shape, has_yaw, on_page);
  if (shape.kind == ShapeKind::kPlanar) return drawDoor(canvas, shape, symbol.color, on_page);
  const auto dark = darkOf(symbol.color);
  const Polygon2 corners = mapped(footprint(shape, 48), on_page);
  canvas.area({corners}, palette::mix(symbol.color, palette::kFree, 0.5));
  if (symbol.variant == 0 && shape.kind == ShapeKind::kCylinder)
    drawStar(canvas, shape.radius(), dark, on_page);
  if (symbol.variant == 0 && shape.kind == ShapeKind::kCuboid && has_yaw)
    drawSeat(canvas, shape, dark, on_page);
  const int kind = symbol.variant == 0 ? 0 : (symbol.variant - 1) % kHatchings + 1;
  if (kind & 1) hatch(canvas, corners, true, dark);
  if (kind & 2) hatch(canvas, corners, false, dark);
  canvas.line(corners, {dark, kOutline_pt}, true);
  if (has_yaw && symbol.variant > 0) drawFront(canvas, shape, dark, on_page);
}

}  // namespace roomgraph
