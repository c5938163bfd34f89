// SPDX-License-Identifier: BSD-3-Clause
// Canny edges and Hough segments of a detection's box, and which of them a depth mask supports.
#pragma once

#include <vector>

#include "roomgraph/observations/frame.h"
#include "roomgraph/proposals/box_evidence.h"

namespace roomgraph {

/// Canny edges and Hough segments of the box with a small rim; empty without an image.
BoxEdges findEdges(const Frame& frame, const Box2& box);

/// Computes the distance transform of the edges; only scoring without depth needs it.
void addDistances(BoxEdges& edges);

double totalLength(const std::vector<Segment2>& segments);

/// The segments whose middle lies on the mask or at its rim; all of them when the mask is empty.
std::vector<Segment2> supportedSegments(const std::vector<Segment2>& segments, const DepthMask& mask,
                                        const Box2& box);

}  // namespace roomgraph
