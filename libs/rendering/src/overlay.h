// SPDX-License-Identifier: BSD-3-Clause
// Title, legend, scale and labels drawn over the picture of a map.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "map_picture.h"
#include "scene_view.h"

namespace roomgraph {

/// "6.0 x 4.0 m,  3 objects,  path 2.7 m": what is said below the title.
std::string factsOf(const MapPicture& picture);
constexpr double kLegendRow = 2.4;  ///< height of a row of the legend in heights of a capital letter

/// Where the map goes in the picture: what title, legend and margins leave over, px.
Box2 mapArea(const SnapshotOptions& options, std::size_t legend_rows = 1);
Box2 mapArea(const MapPicture& picture, const ObjectDatabase& database, const SnapshotOptions& options);
/// Width that the scale takes at most, px.
double roomOfScale(const CSemanticMap& map, const cv::Size& size, double unit_px);
/// Filled rectangle with sub-pixel edges.
void fillBox(cv::Mat& image, const Box2& box, const palette::TColor& color);
/// Names of the objects, title, legend with counts, and scale, onto the rendered BGR image.
void drawOverlay(cv::Mat& image, const MapPicture& picture, const ObjectDatabase& database,
                 const SnapshotOptions& options, const SceneView& view);

}  // namespace roomgraph
