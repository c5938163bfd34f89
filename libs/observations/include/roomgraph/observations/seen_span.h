// SPDX-License-Identifier: BSD-3-Clause
// Times of the first and last measurement of a landmark.
#pragma once

#include <map>

#include "roomgraph/core/ids.h"

namespace roomgraph {

/// When a landmark was measured first and last, s.
struct SeenSpan {
  double first = 0, last = 0;
};

using SeenSpans = std::map<LandmarkId, SeenSpan>;

}  // namespace roomgraph
