// SPDX-License-Identifier: BSD-3-Clause
// Generator of upright cylinders.
#pragma once

#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph {

/// Upright cylinders, which have no yaw: from the near and far side of the depth points; where the box's bottom side or
/// a chair's leg meets the ground; or as far away as the usual size fills the box (method.md sec. 1.A).
class CylinderGenerator : public ShapeGenerator {
  DEFINE_MRPT_OBJECT(CylinderGenerator, roomgraph)
 public:
  std::vector<PlacedShape> generate(const BoxEvidence& evidence, const GeneratorLimits& limits) const override;
};

}  // namespace roomgraph
