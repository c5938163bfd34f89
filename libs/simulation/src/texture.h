// SPDX-License-Identifier: BSD-3-Clause
// Procedural textures by material pattern.
#pragma once

#include <opencv2/core/mat.hpp>

#include "roomgraph/simulation/mesh.h"

namespace roomgraph {

/// Names of the patterns for surfaces, square pictures.
const std::vector<std::string>& texturePatterns();

/// One for posters, 9 by 6 inner corners in 12 by 9 squares.
inline constexpr const char* kChessboardPattern = "chessboard";

/// Procedural picture of a material, BGR 8 bit, the same on every call; patterns that repeat tile
/// seamlessly. Texels are not finer than about 5 mm (the renderer has no mip maps). Throws ConfigError on an
/// unknown pattern.
cv::Mat textureOf(const Material& material);

}  // namespace roomgraph
