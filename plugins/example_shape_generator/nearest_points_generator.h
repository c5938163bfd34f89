// SPDX-License-Identifier: BSD-3-Clause
// Example plug-in: shape generator from the nearest depth points.
#pragma once

#include "roomgraph/proposals/shape_generator.h"

namespace example {

/// One start: the class's usual size, its front to the camera, its near side where the object's depth points begin. The
/// library's fit adjusts it.
class NearestPointsGenerator : public roomgraph::ShapeGenerator {
  DEFINE_MRPT_OBJECT(NearestPointsGenerator, example)
 public:
  void declareParameters(roomgraph::ParameterVisitor& visitor) override;
  std::vector<roomgraph::PlacedShape> generate(const roomgraph::BoxEvidence& evidence,
                                               const roomgraph::GeneratorLimits& limits) const override;

 private:
  double near_share_ = 0.05;
};

}  // namespace example
