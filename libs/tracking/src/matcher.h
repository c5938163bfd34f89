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

/// Guided matching: map points are projected with a predicted pose and compared with the features around
/// that pixel.
struct ProjectionSearch {
  const LocalMap& map;
  const PinholeCamera& camera;
  const Pose3& camera_from_odom;
  double radius_px = 10;  ///< search radius on pyramid level 0; times scale_factor^level on the others

  /// Matches of the given points to features whose entry in `taken` is -1. Each point and each feature occurs
  /// at most once. `in_view`, when given, gets the points that were expected in the image.
  std::vector<PointMatch> match(const std::vector<std::int64_t>& ids, const Features& features,
                                const std::vector<std::int64_t>& taken, const TrackingParameters& parameters,
                                std::vector<std::int64_t>* in_view = nullptr) const;
};

int hammingDistance(const Descriptor& a, const Descriptor& b);

/// (index in a, index in b), ascending in b, by nearest neighbour search from a to b: the Hamming
/// distance is at most max_hamming and at most match_ratio times that of the second nearest in b (Lowe's
/// ratio test). Of several a with the same nearest b only the closest is kept. The reverse search, from b
/// to a, is not made. Nothing when either list has fewer than two descriptors.
std::vector<std::pair<int, int>> matchDescriptors(const std::vector<Descriptor>& a,
                                                  const std::vector<Descriptor>& b,
                                                  const TrackingParameters& parameters);

}  // namespace roomgraph::tracking
