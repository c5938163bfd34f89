// SPDX-License-Identifier: BSD-3-Clause
// Loop closure by objects: rigid 2D transform that aligns most landmarks of two sets, class by class.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/geometry/pose.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

struct ConstellationOptions {
  int min_pairs = 3;            ///< fewer objects in common are no evidence
  double tolerance_m = 0.3;     ///< of an object's place after the transform
  double yaw_tolerance = 0.6;   ///< rad, of an object's front; objects without a yaw fit any
  double min_separation_m = 1;  ///< two objects nearer to each other do not determine a rotation
  int min_lead = 1;             ///< pairs more than the best clearly different transform has
};

/// Transform between two sets of objects, with the pairs that agree.
struct ConstellationMatch {
  Pose2 map_from_query;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< (query, map), ascending
  double rms_m = 0;                                        ///< of the pairs' distances
};

/// The rigid transform on the floor that matches the most objects of `query` with objects of `map`, class by class and
/// one to one (method.md sec. 4: loop closing by objects). Every two objects of `query` and two of `map` at equal
/// distances propose a transform (of more than 15 objects in `query`, those 15 whose classes are rarest in `map`); its inliers are the pairs within tolerance; least squares (Umeyama 1991) refines it.
/// Nothing when there are too few inliers, or when a clearly different transform has nearly as many: a row of equal
/// chairs matches itself in several ways.
std::optional<ConstellationMatch> matchConstellation(const std::vector<Landmark>& query,
                                                     const std::vector<Landmark>& map,
                                                     const ConstellationOptions& options = {});

}  // namespace roomgraph
