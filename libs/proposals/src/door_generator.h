// SPDX-License-Identifier: BSD-3-Clause
// Generator of door shapes on vertical planes.
#pragma once

#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph {

/// Thin upright shapes that stand on the floor like a door's leaf in its frame: on the vertical plane that most depth
/// points of the box lie on; without one, from the box's sides and level lines in the image (method.md sec. 1.C).
class DoorGenerator : public ShapeGenerator {
  DEFINE_MRPT_OBJECT(DoorGenerator, roomgraph)
 public:
  std::vector<PlacedShape> generate(const BoxEvidence& evidence, const GeneratorLimits& limits) const override;
};

}  // namespace roomgraph
