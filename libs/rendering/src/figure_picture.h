// SPDX-License-Identifier: BSD-3-Clause
// Figures of a map or of a part of it as pixels.
#pragma once

#include <opencv2/core/mat.hpp>

#include "map_picture.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/figure.h"

namespace roomgraph {

/// The figure as BGR image.
cv::Mat figurePixels(const MapPicture& picture, const ObjectDatabase& database, const FigureOptions& options);

}  // namespace roomgraph
