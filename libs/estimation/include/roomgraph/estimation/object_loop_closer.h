// SPDX-License-Identifier: BSD-3-Clause
// Loop closing by objects: duplicate constellations of landmarks from two visits.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "roomgraph/estimation/object_mapper.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// Landmarks of two visits that have none in common.
struct Visits {
  std::vector<Landmark> recent, old;
};

/// Every split of the landmarks at a time within `recent_s` before `now`: first seen from then on, and not
/// seen any more since; only those with at least `min_each` landmarks in both visits.
std::vector<Visits> splitByTime(const std::vector<Landmark>& landmarks, const SeenSpans& spans, double now,
                               double recent_s, std::size_t min_each);

/// Verifies a closure by scans or images, and refines it.
using ClosureVerifier = std::function<std::optional<RelativePose>(const RelativePose&)>;

/// Finds recent landmarks in the same constellation as older ones elsewhere: the robot came back with drift (or after
/// being lost) and mapped the same objects again. The constellation gives a candidate, which scans or images verify
/// (method.md sec. 4).
class ObjectLoopCloser {
 public:
  explicit ObjectLoopCloser(const ObjectLoopOptions& options) : options_(options) {}

  /// Called with every new key pose. Returns a verified closure that disagrees with the current
  /// estimate, or nothing.
  std::optional<RelativePose> search(const ObjectMapper& objects, const KeyPoses& poses,
                                     const ClosureVerifier& verify);

 private:
  std::optional<RelativePose> confirm(const ConstellationMatch& match, const Visits& visits,
                                      const SeenSpans& spans, const KeyPoses& poses,
                                      const ClosureVerifier& verify);

  const ObjectLoopOptions& options_;
  int nodes_since_search_ = 0;
  std::map<std::pair<LandmarkId, LandmarkId>, double> refused_;  ///< (recent, old): time of the last attempt
};

}  // namespace roomgraph
