// SPDX-License-Identifier: BSD-3-Clause
// Feature matching by projection and by descriptor.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "local_map.h"

namespace roomgraph::tracking {

struct PointMatch {
  std::int64_t point = -1;
  int feature = -1;
};

/// Points and features found by projecting points with a predicted pose and comparing descriptors nearby.
struct ProjectionSearch {
  const LocalMap& map;
  const PinholeCamera& camera;
  const Pose3& camera_from_odom;
  double radius_px = 10;  ///< on the finest level; grows with the level

  /// Matches of the given points to features whose entry in `taken` is -1. Each point and each feature occurs
  /// at most once. `in_view`, when given, gets the points that were expected in the image.
  std::vector<PointMatch> match(const std::vector<std::int64_t>& ids, const Features& features,
                                const std::vector<std::int64_t>& taken, const TrackingParameters& parameters,
                                std::vector<std::int64_t>* in_view = nullptr) const;
};

int hammingDistance(const Descriptor& a, const Descriptor& b);

/// (index in a, index in b) of mutually best descriptor matches that pass the ratio test.
std::vector<std::pair<int, int>> matchDescriptors(const std::vector<Descriptor>& a,
                                                  const std::vector<Descriptor>& b,
                                                  const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
