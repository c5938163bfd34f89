// SPDX-License-Identifier: BSD-3-Clause
// Symbols of objects seen from above.
#pragma once

#include <functional>

#include "canvas.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/figure.h"

namespace roomgraph {

/// How a class is told from others, in colour and without.
struct Symbol {
  palette::TColor color;
  int variant = 0;  ///< 0: the chair's star, the sofa's back and arms, plain; 1 …: kinds of hatching
};

/// By the place of the class among those of its shape in the database; a class that is not there is hatched
/// grey.
Symbol symbolOf(const ObjectDatabase& database, const std::string& class_name);

/// Draws one object. `on_page` takes (forward, left) in the object's frame, m, to the page, pt.
void drawSymbol(Canvas& canvas, const Symbol& symbol, const ObjectShape& shape, bool has_yaw,
                FigureStyle style, const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& on_page);

}  // namespace roomgraph
