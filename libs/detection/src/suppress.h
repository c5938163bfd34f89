// SPDX-License-Identifier: BSD-3-Clause
// Non-maximum suppression within a class, and of one object that got two labels.
#pragma once

#include <vector>

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// Indices of the boxes that survive non-maximum suppression within their own class, best score first.
std::vector<int> suppressPerClass(const std::vector<RawBox>& boxes, double max_iou);

/// Of `kept` (indices, best first) those that do not nearly coincide with a better box of another class, i.e. a second
/// label of one object.
std::vector<int> suppressTwins(const std::vector<RawBox>& boxes, const std::vector<int>& kept,
                               double max_iou);

}  // namespace roomgraph
