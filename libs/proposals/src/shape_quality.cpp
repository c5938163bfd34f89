// SPDX-License-Identifier: BSD-3-Clause
// Quality of a placed shape: overlap with the box, distance of the points, usual size, edges and front.
#include <algorithm>
#include <cmath>

#include "edge_agreement.h"
#include "front_agreement.h"
#include "roomgraph/proposals/shape_fit.h"
#include "vertical_faces.h"

namespace roomgraph {
namespace {

// Mean distance of the points outside the shape, each at most `most`; m.
double meanOutside(const PlacedShape& placed, const std::vector<MaskPoint>& points, double most) {
  if (points.empty()) return 0;
  const Pose3 object_from_ground = groundFromObject(placed).inverse();
  double sum = 0;
  for (const auto& p : points)
    sum += std::min(most, distanceOutside(placed.shape, object_from_ground * p.in_ground).norm());
  return sum / static_cast<double>(points.size());
}

}  // namespace

void judge(PlacedShape& placed, const BoxEvidence& evidence, const QualityWeights& weights) {
  const ObjectModel& m = *evidence.model;
  const auto& points = evidence.mask.points;
  placed.hidden = evidence.hidden;
  placed.box_iou = boxIou(placed, evidence);
  const double size = m.sizeDistance2(placed.shape);
  placed.quality = placed.box_iou * std::exp(-meanOutside(placed, points, weights.far_outside_m) / weights.outside_m -
                                             weights.size * size);
  if (points.empty())
    if (const auto edges = edgeAgreement(placed, evidence))
      placed.quality *= 1 - weights.edges + weights.edges * *edges;
  if (placed.has_yaw)
    placed.quality *= 1 - weights.faces + weights.faces * faceAgreement(evidence.faces, placed.yaw);
  if (m.frontRule() != FrontRule::kNone)
    placed.quality *= 1 - weights.front + weights.front * frontAgreement(placed, evidence);
}

}  // namespace roomgraph
