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
/// Where the map goes in the picture: what title, legend and margins leave over, px.
Box2 mapArea(const SnapshotOptions& options);
/// Names of the objects, title, legend with counts, and scale, onto the rendered BGR image.
void drawOverlay(cv::Mat& image, const MapPicture& picture, const ObjectDatabase& database,
                 const SnapshotOptions& options, const SceneView& view);

}  // namespace roomgraph
