// SPDX-License-Identifier: BSD-3-Clause
// Start from the nearest points and fit, registered when the plug-in is loaded.
#include "nearest_points_generator.h"

#include <mrpt/core/initializer.h>

#include <algorithm>
#include <cmath>

#include "roomgraph/core/plugin.h"
#include "roomgraph/proposals/shape_fit.h"

ROOMGRAPH_PLUGIN()

namespace example {

IMPLEMENTS_MRPT_OBJECT(NearestPointsGenerator, roomgraph::ShapeGenerator, example)

void NearestPointsGenerator::declareParameters(roomgraph::ParameterVisitor& v) {
  v.add("near_share", near_share_,
        {.doc = "Share of the points that may be nearer by mistake.", .min = 0, .max = 0.5});
}

std::vector<roomgraph::PlacedShape> NearestPointsGenerator::generate(const roomgraph::BoxEvidence& evidence,
                                                                     const roomgraph::GeneratorLimits& limits) const {
  std::vector<double> ranges;
  for (const auto& point : evidence.mask.points) ranges.push_back(point.in_ground.head<2>().norm());
  if (ranges.empty()) return {};
  std::sort(ranges.begin(), ranges.end());
  const double nearest = ranges[static_cast<std::size_t>(near_share_ * static_cast<double>(ranges.size() - 1))];

  roomgraph::PlacedShape start = roomgraph::usualShape(evidence);
  const double bearing = roomgraph::bearingOf(evidence), range = nearest + start.shape.depth / 2;
  start.x = range * std::cos(bearing);
  start.y = range * std::sin(bearing);
  start.yaw = roomgraph::wrapAngle(bearing + M_PI);
  start.has_yaw = start.shape.kind != roomgraph::ShapeKind::kCylinder;
  start.source = "nearest points";
  return roomgraph::keepBest({roomgraph::fitShape(start, evidence)}, {}, limits);
}

}  // namespace example

// Runs when the library is loaded, before the configuration asks for the class.
MRPT_INITIALIZER(registerExampleShapeGenerator) {
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(NearestPointsGenerator, example));
}
