// SPDX-License-Identifier: BSD-3-Clause
// Initialisation score of a detection from area, edges and depth.
#pragma once

#include <string>

#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// Initialisation score of a detection (method.md sec. 1.5) and its three parts, all in [0, 1].
struct InitialScore {
  double value = 0, area = 0, edges = 0, depth = 0;
  std::string text() const;
};

/// The edge part is the length of the segments in the box that the depth mask supports, over the box's
/// perimeter; 0 without an image.
InitialScore initialScore(const BoxEvidence& evidence);

}  // namespace roomgraph
