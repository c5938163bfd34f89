// SPDX-License-Identifier: BSD-3-Clause
// Drawings of a map in SVG.
#pragma once

#include <string>

#include "region.h"

namespace roomgraph {

/// Extent of a drawing in world: known cells, objects and path, with a margin. Throws RunError for an empty
/// map.
Eigen::AlignedBox2d drawingBounds(const CSemanticMap& map);
/// Places at least 5 cm apart along the path; a new piece after a gap of 1 m, as between two sessions.
std::vector<Polygon2> pathPieces(const CSemanticMap& map);

/// An SVG picture that is built up in world coordinates (m); y points upwards.
class SvgDrawing {
 public:
  /// 1 : scale on paper.
  SvgDrawing(const Eigen::AlignedBox2d& bounds, double scale);

  void beginGroup(const std::string& id, const std::string& attributes);
  void endGroup();
  /// One path of several closed polygons; holes are holes.
  void area(const std::vector<Polygon2>& polygons, const std::string& attributes);
  void polygon(const Polygon2& corners, const std::string& attributes, const std::string& title = "");
  void polyline(const Polygon2& points, const std::string& attributes);
  /// Centred; size in m.
  void text(const Eigen::Vector2d& at, double size_m, const std::string& words,
            const std::string& attributes = "");
  /// A bar of whole metres at the lower left.
  void scaleBar();
  std::string finished() const;

 private:
  std::string point(const Eigen::Vector2d& at) const;

  Eigen::AlignedBox2d bounds_;
  std::string text_;
};

/// Free space and walls of the map, as a background.
void drawFloor(const CSemanticMap& map, SvgDrawing& drawing);

}  // namespace roomgraph
