// SPDX-License-Identifier: BSD-3-Clause
// Small semantic map of an asymmetric room for tests.
#pragma once

#include <string>
#include <utility>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph::test {

inline Landmark sampleLandmark(std::int64_t id, const std::string& class_name, ShapeKind kind, double x,
                               double y) {
  Landmark landmark;
  landmark.id.value = id;
  landmark.class_name = class_name;
  landmark.model = class_name + "_model";
  landmark.shape = {kind, 0.7, 0.5, 0.9};
  if (kind == ShapeKind::kCylinder) landmark.shape.depth = landmark.shape.width;
  landmark.position = {x, y, 0.01};
  landmark.yaw = 0.6;
  landmark.has_yaw = kind != ShapeKind::kCylinder;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) landmark.covariance(i, j) = i == j ? 0.01 * (i + 1) : 0.001 * (i + j);
  landmark.existence = 0.93;
  landmark.class_posterior = {{class_name, 0.8}, {"other", 0.2}};
  landmark.observations = 17;
  return landmark;
}

/// A 6 m x 4 m room with walls, three objects and a short path; nothing about it is symmetrical.
inline CSemanticMap sampleMap() {
  CSemanticMap map;
  map.origin = "sample.rawlog";
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-1.f, 5.f, -2.f, 2.f, 0.05f);
  map.occupancy->fill(0.99f);
  const int width = static_cast<int>(map.occupancy->getSizeX()),
            height = static_cast<int>(map.occupancy->getSizeY());
  for (int x = 0; x < width; ++x)
    for (int y : {0, 1, height - 2, height - 1}) map.occupancy->setCell(x, y, 0.01f);
  for (int y = 0; y < height; ++y)
    for (int x : {0, 1, width - 2, width - 1}) map.occupancy->setCell(x, y, 0.01f);
  map.landmarks = {sampleLandmark(1, "swivel_chair", ShapeKind::kCylinder, 1.0, 1.0),
                   sampleLandmark(2, "sofa", ShapeKind::kCuboid, 3.6, -1.0),
                   sampleLandmark(7, "door", ShapeKind::kPlanar, 4.2, 1.2)};
  for (int i = 0; i < 40; ++i)
    map.world_from_robot.push_back(
        {1000 + 0.1 * i, poseFromYpr(0.07 * i, -0.001 * i * i, 0, -0.02 * i, 0, 0)});
  return map;
}

}  // namespace roomgraph::test
