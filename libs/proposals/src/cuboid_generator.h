// SPDX-License-Identifier: BSD-3-Clause
// Generator of upright cuboids.
#pragma once

#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph {

/// Upright cuboids: from an L shape in the footprint of the depth points; without depth from vanishing points and the
/// box's sides, from the box's contact with the ground, or from the usual size (method.md sec. 1.B).
class CuboidGenerator : public ShapeGenerator {
  DEFINE_MRPT_OBJECT(CuboidGenerator, roomgraph)
 public:
  std::vector<PlacedShape> generate(const BoxEvidence& evidence, const GeneratorLimits& limits) const override;
};

}  // namespace roomgraph
