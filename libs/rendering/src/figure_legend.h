// SPDX-License-Identifier: BSD-3-Clause
// Legend and scale bar of figures and plans.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "canvas.h"
#include "map_picture.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/figure.h"

namespace roomgraph {

/// A word and what it stands for, drawn around a point of the page (pt).
struct LegendEntry {
  std::string text;
  double width = 0;  ///< of the symbol, pt
  std::function<void(Canvas& canvas, const Eigen::Vector2d& centre)> draw;
  std::string longest{};  ///< text that there must be room for, as counts grow in a film; empty: that of now
};

constexpr double kLegendText_pt = 8, kLegendRow_pt = 17;

/// Classes with counts, walls, free space, path: what the whole of the picture has.
std::vector<LegendEntry> legendOf(const MapPicture& picture, const ObjectDatabase& database,
                                  FigureStyle style);
/// Rows that the entries take in this width, pt.
int legendRows(Canvas& canvas, const std::vector<LegendEntry>& entries, double width);
/// Draws the rows downwards from the upper left corner.
void drawLegend(Canvas& canvas, const std::vector<LegendEntry>& entries, const Eigen::Vector2d& corner,
                double width);

/// Length of a bar of about a fifth of the width (an eighth to a third), a round number of metres.
double scaleBarLength(double world_width_m);
/// Half black, half white, with figures above (that of the middle when there is room); its lower right end at
/// `end`.
void drawScaleBar(Canvas& canvas, double length_m, double points_per_m, const Eigen::Vector2d& end);

}  // namespace roomgraph
