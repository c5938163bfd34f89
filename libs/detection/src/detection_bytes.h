// SPDX-License-Identifier: BSD-3-Clause
// What a detector found in a frame as bytes and back, with nothing lost.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/detection.h"

namespace roomgraph {

/// Detections, or why there are none. Masks are binary (0 / 255).
std::string bytesOf(const Outcome<std::vector<Detection>>& found);
/// What bytesOf() was given. Throws std::exception when they are none.
Outcome<std::vector<Detection>> detectionsFrom(const std::string& bytes);

}  // namespace roomgraph
