// SPDX-License-Identifier: BSD-3-Clause
// Non-maximum suppression within a class, and of one object that got two labels.
#pragma once

#include <vector>

#include "roomgraph/detection/network_decoder.h"
#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Indices of the boxes that survive non-maximum suppression among those of their class and network, best score first.
std::vector<int> suppressPerClass(const std::vector<RawBox>& boxes, double max_iou);

/// Of `kept` (indices, best first) one for each thing of one class that several networks found, best first: those of different
/// networks whose IoU with the best one is larger. That box becomes the mean of their sides, weighted by the scores, which are
/// to be probabilities, or that of the best with a mask; its score that at least one of them is right, were they independent.
std::vector<int> fuseNetworks(std::vector<RawBox>& boxes, const std::vector<int>& kept, double max_iou);

/// Of `kept` (indices, best first) those that do not nearly coincide with a better box of another class, i.e. a second
/// label of one object.
std::vector<int> suppressTwins(const std::vector<RawBox>& boxes, const std::vector<int>& kept,
                               double max_iou);

/// Sets the rival score of every detection of a mapped class: that of the best box in the same place, among
/// `others` and the detections, with a label of no mapped class (a printer, a person).
void setRivals(std::vector<Detection>& detections, const std::vector<Detection>& others,
               const ObjectDatabase& database);

}  // namespace roomgraph
