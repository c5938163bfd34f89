// SPDX-License-Identifier: BSD-3-Clause
// SVG elements, floor and walls, extent of a drawing.
#include "drawing.h"

#include "roomgraph/core/errors.h"
#include "roomgraph/core/markup.h"
#include "roomgraph/maptools/grid_outlines.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

constexpr double kEdge_m = 0.4, kPathStep_m = 0.05, kPathGap_m = 1;

}  // namespace

Eigen::AlignedBox2d drawingBounds(const CSemanticMap& map) {
  Eigen::AlignedBox2d box;
  for (const auto& landmark : map.landmarks) box.extend(boundsOf(footprintOf(landmark)));
  for (const auto& piece : pathPieces(map)) box.extend(boundsOf(piece));
  if (map.occupancy)
    for (int y = 0; y < static_cast<int>(map.occupancy->getSizeY()); ++y)
      for (int x = 0; x < static_cast<int>(map.occupancy->getSizeX()); ++x)
        if (const float p = map.occupancy->getCell(x, y); isFreeCell(p) || isOccupiedCell(p))
          box.extend(cellCentre(*map.occupancy, x, y));
  if (box.isEmpty()) throw RunError("the map is empty: there is nothing to draw");
  box.min().array() -= kEdge_m;
  box.max().array() += kEdge_m;
  return box;
}

std::vector<Polygon2> pathPieces(const CSemanticMap& map) {
  std::vector<Polygon2> pieces;
  for (const auto& stamped : map.world_from_robot) {
    const Eigen::Vector2d p = stamped.pose.translation().head<2>();
    const double step = pieces.empty() ? kPathGap_m : (p - pieces.back().back()).norm();
    if (step >= kPathGap_m)
      pieces.push_back({p});
    else if (step >= kPathStep_m)
      pieces.back().push_back(p);
  }
  return pieces;
}

SvgDrawing::SvgDrawing(const Eigen::AlignedBox2d& bounds, double scale) : bounds_(bounds) {
  const Eigen::Vector2d size = bounds.sizes();
  const double mm = 1000 / scale;
  text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
          decimals(size.x() * mm) + "mm\" height=\"" + decimals(size.y() * mm) + "mm\" viewBox=\"0 0 " +
          decimals(size.x()) + " " + decimals(size.y()) +
          "\" font-family=\"sans-serif\">\n<desc>1 : " + decimals(scale, 0) + ", world x from " +
          decimals(bounds.min().x()) + " m, y up to " + decimals(bounds.max().y()) +
          " m</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"#e9ecf1\"/>\n";
}

std::string SvgDrawing::point(const Eigen::Vector2d& at) const {
  return decimals(at.x() - bounds_.min().x()) + "," + decimals(bounds_.max().y() - at.y());
}

void SvgDrawing::beginGroup(const std::string& id, const std::string& attributes) {
  text_ += "<g id=\"" + id + "\" " + attributes + ">\n";
}

void SvgDrawing::endGroup() {
  text_ += "</g>\n";
}

void SvgDrawing::area(const std::vector<Polygon2>& polygons, const std::string& attributes) {
  text_ += "<path fill-rule=\"evenodd\" " + attributes + " d=\"";
  for (const auto& corners : polygons) {
    for (std::size_t i = 0; i < corners.size(); ++i) text_ += (i ? " " : "M") + point(corners[i]);
    text_ += "Z";
  }
  text_ += "\"/>\n";
}

void SvgDrawing::polygon(const Polygon2& corners, const std::string& attributes, const std::string& title) {
  text_ += "<polygon " + attributes + " points=\"";
  for (std::size_t i = 0; i < corners.size(); ++i) text_ += (i ? " " : "") + point(corners[i]);
  text_ += title.empty() ? "\"/>\n" : "\"><title>" + escapedForMarkup(title) + "</title></polygon>\n";
}

void SvgDrawing::polyline(const Polygon2& points, const std::string& attributes) {
  text_ += "<polyline fill=\"none\" " + attributes + " points=\"";
  for (std::size_t i = 0; i < points.size(); ++i) text_ += (i ? " " : "") + point(points[i]);
  text_ += "\"/>\n";
}

void SvgDrawing::text(const Eigen::Vector2d& at, double size_m, const std::string& words,
                      const std::string& attributes) {
  const std::string place = point(at);
  const auto comma = place.find(',');
  text_ += "<text text-anchor=\"middle\" x=\"" + place.substr(0, comma) + "\" y=\"" +
           place.substr(comma + 1) + "\" font-size=\"" + decimals(size_m) + "\" " + attributes + ">" +
           escapedForMarkup(words) + "</text>\n";
}

void SvgDrawing::scaleBar() {
  const double length = std::max(1.0, std::floor(bounds_.sizes().x() / 6));
  const Eigen::Vector2d at = bounds_.min() + Eigen::Vector2d(kEdge_m / 2, kEdge_m / 2);
  polyline({at, at + Eigen::Vector2d(length, 0)}, "stroke=\"#262e3a\" stroke-width=\"0.04\"");
  text(at + Eigen::Vector2d(length / 2, 0.06), 0.16, decimals(length, 0) + " m", "fill=\"#262e3a\"");
}

std::string SvgDrawing::finished() const {
  return text_ + "</svg>\n";
}

void drawFloor(const CSemanticMap& map, SvgDrawing& drawing) {
  if (!map.occupancy) return;
  drawing.beginGroup("free", "fill=\"#ffffff\"");
  drawing.area(simplified(outlinesOf(*map.occupancy, isFreeCell), outlineTolerance(*map.occupancy)), "");
  drawing.endGroup();
  drawing.beginGroup("walls", "fill=\"#3a4657\"");
  drawing.area(simplified(outlinesOf(*map.occupancy, isOccupiedCell), outlineTolerance(*map.occupancy)), "");
  drawing.endGroup();
}

}  // namespace roomgraph
