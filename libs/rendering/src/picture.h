// SPDX-License-Identifier: BSD-3-Clause
// The picture of a map or of a part of it as pixels.
#pragma once

#include <opencv2/core/mat.hpp>

#include "map_picture.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/snapshot.h"

namespace roomgraph {

/// The picture as BGR image of the size asked for, rendered off-screen. Throws NoRenderer.
cv::Mat renderPicture(const MapPicture& picture, const ObjectDatabase& database,
                      const SnapshotOptions& options);

}  // namespace roomgraph
