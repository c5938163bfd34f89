// SPDX-License-Identifier: BSD-3-Clause
// Agreement of matches with older submaps on where a segment lies.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "closure_confirmation.h"

namespace roomgraph {

/// Holds back what single scans say of where a segment lies that no movement ties to older ones: rooms of one shape look
/// alike. Believed is a place on which eight scans agree that span three metres of path, of the last fifteen, when at most a quarter as many
/// say anything else. Unlike ClosureConfirmation it compares closures with any older scans, by where these are in world.
class PlaceVotes {
 public:
  /// Where a kept scan is in world.
  using PlaceOf = std::function<std::optional<Pose2>(int scan)>;
  /// Takes a closure; returns those that agree with it once they are believed. `piece`: of the path, to which its older scan belongs: those of
  /// other pieces lie anywhere else.
  std::vector<Closure> add(const Closure& closure, int piece, const std::vector<WayPoint>& way, const PlaceOf& placeOf);
  /// Those with a piece say nothing more: it is tied.
  void forget(int piece);

 private:
  struct Vote {
    Closure closure;
    int piece = 0;
  };
  std::vector<Vote> votes_;
};

}  // namespace roomgraph
