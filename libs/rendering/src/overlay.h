// SPDX-License-Identifier: BSD-3-Clause
// Title, legend, scale and labels drawn over the picture of a map.
#pragma once

#include <opencv2/core/mat.hpp>

#include "scene_view.h"

namespace roomgraph {

/// Where the map goes in the picture: what title, legend and margins leave over, px.
Box2 mapArea(const SnapshotOptions& options);
/// Names of the objects, title, legend with counts, and scale, onto the rendered BGR image.
void drawOverlay(cv::Mat& image, const CSemanticMap& map, const ObjectDatabase& database,
                 const SnapshotOptions& options, const SceneView& view);

}  // namespace roomgraph
