// SPDX-License-Identifier: BSD-3-Clause
// One map of pieces of one recording that overlap in time.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Where the path of a later piece lies in the frame of an earlier one.
struct PathAlignment {
  Pose2 a_from_b;
  int poses = 0;             ///< instants that both have
  double rms_m = 0;          ///< of what is left between the two paths
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the common path, in frame a
};

/// From the poses of the same instants (to the microsecond): medians, which the first moments of a piece,
/// when it knows its place badly, do not pull. Nothing, with the reason, when fewer than 5 instants are
/// common, or the paths differ by more than .5 m (rms).
Outcome<PathAlignment> alignPaths(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b);

/// Two paths in one frame as one, in order of time: where both have a pose, it goes over from the first to
/// the second in equal parts of time.
std::vector<StampedPose> joinedPaths(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b);

/// A map with one more piece.
struct PieceUnion {
  CSemanticMap map;
  Pose2 a_from_b;        ///< of the piece
  PathAlignment paths;   ///< what their common time says
  bool by_maps = false;  ///< objects and walls agree with it and were more exact
  std::string why_not;   ///< what is said against the maps otherwise
};

/// `a` continued by a later piece of the same recording. The paths tell where it lies; objects and walls
/// (alignMaps) correct that when they are certain and agree with it within .5 m and .1 rad. Nothing, with the
/// reason, when the paths do not tell.
Outcome<PieceUnion> unitedPieces(const CSemanticMap& a, const CSemanticMap& b);

}  // namespace roomgraph
