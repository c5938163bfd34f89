// SPDX-License-Identifier: BSD-3-Clause
// ClosureGate: which loop closures by images may enter the graph.
#pragma once

#include <vector>

#include "roomgraph/estimation/drift.h"

namespace roomgraph {

/// Places look alike: walls with one pattern, doors of one make. A loop closure by images that contradicts
/// the drift since its beginning is refused; one that would move the estimate far waits for a second one, of
/// other views, that says the same (cf. Mangelson et al., "Pairwise consistent measurement set maximization
/// for robust multi-robot map merging", ICRA 2018). Closures of other sources, and links between segments,
/// pass.
class ClosureGate {
 public:
  /// Those of `offered`, which end at about the latest key pose, and of the waiting ones that may enter now.
  std::vector<RelativePose> admit(const std::vector<RelativePose>& offered, const KeyPoses& poses,
                                  const Drift& drift);
  /// Whether a closure far from the estimate enters with a witness only: those of images do.
  static bool needsWitness(const RelativePose& closure) {
    return !closure.link && closure.source == "tracking";
  }
  int refused() const { return refused_; }

 private:
  std::vector<RelativePose> waiting_;
  int refused_ = 0;
};

}  // namespace roomgraph
