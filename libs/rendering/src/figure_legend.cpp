// SPDX-License-Identifier: BSD-3-Clause
// Rows of symbols and words; bar of round length.
#include "figure_legend.h"

#include <cmath>
#include <map>

#include "class_counts.h"
#include "map_drawing.h"
#include "roomgraph/rendering/scene_parts.h"
#include "symbols.h"

namespace roomgraph {
namespace {

constexpr double kSymbol_pt = 12, kAfterSymbol_pt = 5, kAfterEntry_pt = 15;

std::string decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

double entryWidth(Canvas& canvas, const LegendEntry& entry) {
  const std::string& text = entry.longest.empty() ? entry.text : entry.longest;
  return entry.width + kAfterSymbol_pt + canvas.textWidth(text, {kLegendText_pt}) + kAfterEntry_pt;
}

/// The class's usual shape, as large as a legend has room for.
LegendEntry entryOf(const std::string& name, const ClassCount& count, const Landmark& example,
                    const ObjectDatabase& database, FigureStyle style) {
  ObjectShape shape = example.shape;
  const bool flat = shape.kind == ShapeKind::kPlanar;
  const double width = flat || shape.kind == ShapeKind::kCuboid ? 1.45 * kSymbol_pt : kSymbol_pt;
  if (!flat && shape.kind == ShapeKind::kCuboid) shape.depth = shape.width * kSymbol_pt / width * 0.75;
  const double scale = width / shape.width;
  const Symbol symbol = symbolOf(database, name);
  const bool has_yaw = style == FigureStyle::kPaper && symbol.variant == 0 && example.has_yaw;
  return {withCount(name, count.shown), width, [=](Canvas& canvas, const Eigen::Vector2d& centre) {
            // Front towards the reader.
            drawSymbol(canvas, symbol, shape, has_yaw, style, [&](const Eigen::Vector2d& at) {
              return Eigen::Vector2d(centre + scale * Eigen::Vector2d(at.y(), at.x()));
            });
          }, withCount(name, count.whole)};
}

LegendEntry swatch(const std::string& text, const palette::TColor& color, bool rim) {
  return {text, kSymbol_pt, [=](Canvas& canvas, const Eigen::Vector2d& centre) {
            const double x = kSymbol_pt / 2, y = kSymbol_pt / 2 - 1.5;
            const Polygon2 box{centre + Eigen::Vector2d(-x, -y), centre + Eigen::Vector2d(x, -y),
                               centre + Eigen::Vector2d(x, y), centre + Eigen::Vector2d(-x, y)};
            canvas.area({box}, color);
            if (rim) canvas.line(box, {palette::kFaintInk, 0.4}, true);
          }};
}

LegendEntry pathEntry(FigureStyle style) {
  constexpr double kLength_pt = 26;
  return {
      "path, start to end", kLength_pt, [=](Canvas& canvas, const Eigen::Vector2d& centre) {
        const Eigen::Vector2d left = centre - Eigen::Vector2d(kLength_pt / 2 - 3, 0);
        constexpr int kSteps = 16;
        for (int i = 0; i < kSteps; ++i) {
          const auto at = [&](int k) {
            return Eigen::Vector2d(left + Eigen::Vector2d(k * 20.0 / kSteps, 0));
          };
          const double late = style == FigureStyle::kPaper ? 1 : i / (kSteps - 1.0);
          canvas.line({at(i), at(i + 1)}, {palette::mix(palette::kPathStart, palette::kPathEnd, late), 1.1});
        }
        canvas.area({circleAt(left, 3)}, palette::kPathEnd);
        canvas.area({circleAt(left, 1.9)}, palette::kFree);
        const Eigen::Vector2d tip = left + Eigen::Vector2d(20, 0);
        canvas.area(
            {{tip + Eigen::Vector2d(4, 0), tip + Eigen::Vector2d(-3, 3.2), tip + Eigen::Vector2d(-3, -3.2)}},
            palette::kPathEnd);
      }};
}

}  // namespace

std::vector<LegendEntry> legendOf(const MapPicture& picture, const ObjectDatabase& database,
                                  FigureStyle style) {
  std::map<std::string, const Landmark*> examples;
  for (const auto& landmark : picture.whole.landmarks) examples[landmark.class_name] = &landmark;
  std::vector<LegendEntry> entries;
  for (const auto& [name, count] : classCounts(picture))
    entries.push_back(entryOf(name, count, *examples[name], database, style));
  if (picture.whole.occupancy) {
    entries.push_back(swatch("obstacle", shadesOf(style).wall, false));
    entries.push_back(swatch("free", shadesOf(style).free, true));
  }
  if (!picture.whole.world_from_robot.empty()) entries.push_back(pathEntry(style));
  return entries;
}

int legendRows(Canvas& canvas, const std::vector<LegendEntry>& entries, double width) {
  int rows = entries.empty() ? 0 : 1;
  double x = 0;
  for (const auto& entry : entries) {
    const double needed = entryWidth(canvas, entry);
    if (x > 0 && x + needed - kAfterEntry_pt > width) ++rows, x = 0;
    x += needed;
  }
  return rows;
}

void drawLegend(Canvas& canvas, const std::vector<LegendEntry>& entries, const Eigen::Vector2d& corner,
                double width) {
  double x = 0, y = corner.y() + kLegendRow_pt / 2;
  for (const auto& entry : entries) {
    const double needed = entryWidth(canvas, entry);
    if (x > 0 && x + needed - kAfterEntry_pt > width) y += kLegendRow_pt, x = 0;
    entry.draw(canvas, {corner.x() + x + entry.width / 2, y});
    canvas.text({corner.x() + x + entry.width + kAfterSymbol_pt, y + 0.36 * kLegendText_pt}, entry.text,
                {kLegendText_pt});
    x += needed;
  }
}

double scaleBarLength(double world_width_m) {
  double length = 1e-2;
  while (true) {
    for (const double factor : {1.0, 2.0, 5.0})
      if (length * factor > world_width_m / 8) return length * factor;
    length *= 10;
  }
}

void drawScaleBar(Canvas& canvas, double length_m, double points_per_m, const Eigen::Vector2d& end) {
  constexpr double kHeight_pt = 3, kRoomForHalf_pt = 56;
  const double length = length_m * points_per_m;
  const auto box = [&](double from, double to) {
    return Polygon2{end + Eigen::Vector2d(from - length, -kHeight_pt),
                    end + Eigen::Vector2d(to - length, -kHeight_pt), end + Eigen::Vector2d(to - length, 0),
                    end + Eigen::Vector2d(from - length, 0)};
  };
  canvas.area({box(0, length)}, palette::kFree);
  canvas.area({box(0, length / 2)}, palette::kInk);
  canvas.line(box(0, length), {palette::kInk, 0.5}, true);
  const Lettering style{0.85 * kLegendText_pt, palette::kInk, TextAlign::kCenter};
  const double y = end.y() - kHeight_pt - 3;
  canvas.text({end.x() - length, y}, "0", style);
  if (length > kRoomForHalf_pt) canvas.text({end.x() - length / 2, y}, decimal(length_m / 2), style);
  canvas.text({end.x(), y}, decimal(length_m) + " m", style);
}

}  // namespace roomgraph
