// SPDX-License-Identifier: BSD-3-Clause
// A map drawn from above on a part of a page.
#pragma once

#include <Eigen/Geometry>

#include "canvas.h"
#include "map_picture.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/figure.h"

namespace roomgraph {

/// Where a rectangle of the world lies on a page, y upwards.
struct PagePlace {
  Eigen::AlignedBox2d world;                         ///< m
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< upper left one on the page, pt
  double points_per_m = 1;
  Eigen::Vector2d operator()(const Eigen::Vector2d& at) const {
    return corner + points_per_m * Eigen::Vector2d(at.x() - world.min().x(), world.max().y() - at.y());
  }
  Eigen::Vector2d size() const { return points_per_m * world.sizes(); }
};

/// What stands beside the objects.
enum class ObjectNames { kNumber, kClassAndNumber };

/// Floor, path, objects and their names; in the style of the screen also the grid of metres.
void drawMap(Canvas& canvas, const MapPicture& picture, const ObjectDatabase& database, FigureStyle style,
             ObjectNames names, const PagePlace& place);

/// The part of the world that a drawing of this map shows: its content and a margin.
Eigen::AlignedBox2d drawnWorld(const CSemanticMap& map);

/// The shades of a style.
struct FloorShades {
  palette::TColor page, free, wall;
};
FloorShades shadesOf(FigureStyle style);

}  // namespace roomgraph
