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

/// Puts every label beside its object so that labels keep off each other, off objects, and inside `area`:
/// each in turn takes the best of the places around its object (below first), near ones before far ones.
void placeLabels(std::vector<Label>& labels, const Box2& area);

}  // namespace roomgraph
