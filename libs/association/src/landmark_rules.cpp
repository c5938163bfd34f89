// SPDX-License-Identifier: BSD-3-Clause
// Initial landmark of a sighting, weights by score and visibility, duplicate test by overlap and distance.
#include "roomgraph/association/landmark_rules.h"

#include <algorithm>

namespace roomgraph {
namespace {

constexpr double kOneThing = 0.5;

}  // namespace

Landmark initializeLandmark(const WorldMeasurement& seen, LandmarkId id, double existence) {
  const auto& proposal = seen.measurement.proposal;
  Landmark landmark;
  landmark.id = id;
  landmark.class_name = proposal.class_name;
  landmark.model = proposal.model;
  landmark.shape = proposal.shape;
  landmark.position = seen.world_from_object.translation();
  landmark.yaw = planarPart(seen.world_from_object).yaw;
  landmark.has_yaw = proposal.has_yaw;
  landmark.covariance = seen.covariance;
  landmark.existence = existence;
  landmark.class_posterior[proposal.class_name] = 1;
  landmark.observations = 1;
  return landmark;
}

double sightingWeight(const ObjectMeasurement& measurement) {
  return measurement.proposal.score * (measurement.detection.carried ? kCarriedShare : 1);
}

double visibleFraction(const ObjectMeasurement& measurement) {
  const auto& projected = measurement.proposal.projected;
  const double full = projected.full.area();
  return full > 0 ? std::clamp(projected.visible.area() / full, 0.0, 1.0) : 1;
}

void DuplicateRule::declare(ParameterVisitor& v) {
  v.add("merge_overlap", merge_overlap,
        {.doc = "Two landmarks of one class with a larger 3D IoU are merged.", .min = 0.01, .max = 1});
  v.add(
      "merge_distance_ratio", merge_distance_ratio,
      {.doc = "Two landmarks of one class that are nearer, in widths of the object, are merged unless frames "
              "show both.",
       .min = 0,
       .max = 5});
  v.add("apart_share", apart_share,
        {.doc =
             "Two landmarks are two objects when at least this share of the sightings of one shows the other "
             "as well.",
         .min = 0,
         .max = 1});
  v.add("split_distance_ratio", split_distance_ratio,
        {.doc = "A landmark is split when its sightings form two groups at this distance, in widths of the "
                "object.",
         .min = 0.1,
         .max = 5});
}

bool DuplicateRule::seenApart(const Landmark& a, const Landmark& b, int together) const {
  return together > apart_share * std::min(a.observations, b.observations);
}

bool DuplicateRule::same(const Landmark& a, const Landmark& b, int together) const {
  if (a.class_name != b.class_name) return false;
  const double width = std::max({a.shape.width, a.shape.depth, b.shape.width, b.shape.depth});
  const double distance = (a.position - b.position).head<2>().norm();
  if (distance > 2 * width) return false;
  const double overlap = iou3d(a.shape, a.worldFromObject(), b.shape, b.worldFromObject());
  // Both in one frame: two objects, or two boxes around one, which then cover each other.
  if (seenApart(a, b, together)) return overlap > kOneThing;
  return overlap > merge_overlap || distance < merge_distance_ratio * width;
}

}  // namespace roomgraph
