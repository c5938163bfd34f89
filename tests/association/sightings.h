// SPDX-License-Identifier: BSD-3-Clause
// Landmarks and sightings for the association tests.
#pragma once

#include <string>

#include "roomgraph/association/associator.h"

namespace roomgraph::test {

inline Landmark landmarkAt(std::int64_t id, double x, double y, double sigma_m = 0.1,
                           const std::string& class_name = "chair") {
  Landmark landmark;
  landmark.id = LandmarkId{id};
  landmark.class_name = class_name;
  landmark.shape = {ShapeKind::kCuboid, 0.6, 0.6, 0.9};
  landmark.position = {x, y, 0};
  landmark.covariance = sigma_m * sigma_m * Eigen::Matrix4d::Identity();
  landmark.existence = 0.5;
  return landmark;
}

inline WorldMeasurement sightingAt(double x, double y, double yaw = 0, double sigma_m = 0.1,
                                   const std::string& class_name = "chair") {
  WorldMeasurement seen;
  seen.measurement.proposal.class_name = class_name;
  seen.measurement.proposal.model = class_name;
  seen.measurement.proposal.shape = {ShapeKind::kCuboid, 0.6, 0.6, 0.9};
  seen.measurement.proposal.has_yaw = true;
  seen.measurement.proposal.score = 1;
  seen.world_from_object = poseFromYpr(x, y, 0, yaw, 0, 0);
  seen.covariance = sigma_m * sigma_m * Eigen::Matrix4d::Identity();
  return seen;
}

/// Share of the posterior; 0 for landmarks that are not in it.
inline double probabilityOf(const Association& association, LandmarkId id) {
  double sum = 0;
  for (const auto& [landmark, probability] : association.posterior)
    if (landmark == id) sum += probability;
  return sum;
}

/// The decision that a measurement belongs to a landmark; invalid id: to a new one.
inline Association belongsTo(LandmarkId landmark) {
  Association association;
  association.landmark = landmark;
  return association;
}

}  // namespace roomgraph::test
