// SPDX-License-Identifier: BSD-3-Clause
// Placement of labels beside objects without overlap.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// A text that belongs to an object in the picture.
struct Label {
  std::string text;
  Box2 object;                   ///< bounds of the object, px
  double width = 0, height = 0;  ///< of the text, px
  Box2 place;                    ///< where placeLabels put it
};

/// Greedy label placement: each label in turn takes the candidate position around its object with the
/// least overlap with earlier labels, with objects and with the outside of `area`; below the object and
/// near to it are preferred.
void placeLabels(std::vector<Label>& labels, const Box2& area);

}  // namespace roomgraph
