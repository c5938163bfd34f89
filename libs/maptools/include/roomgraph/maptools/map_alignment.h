// SPDX-License-Identifier: BSD-3-Clause
// The frame of one map in another, and how sure it is.
#pragma once

#include <string>

#include "roomgraph/core/outcome.h"
#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

struct MapAlignmentOptions {
  bool same_frame = false;          ///< the maps are in one frame already: nothing is searched or moved
  double least_probability = 0.95;  ///< that the transform is right; below it there is none
  double least_explained =
      0.6;                     ///< share of walls of either map, seen by both, that lie on walls of the other
  double least_walls_m = 4;    ///< length of the walls that both saw
  double least_overlap = 0.3;  ///< share of the smaller map's area that the other one saw
};

/// a_from_b with what speaks for it.
struct MapAlignment {
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw), in frame a
  double probability = 1;                                ///< against other transforms, and against none
  double explained = 0;                                  ///< share of the walls seen by both that agree
  double walls_m = 0;                                    ///< length of these walls
  double overlap = 0;                                    ///< share of the smaller map's area that both saw
  int pairs = 0;  ///< objects of one class that come to lie on each other
};

/// Transforms are proposed by the objects (matchConstellation) and by the walls (exact search over the whole
/// plane), refined on the grid, and weighed: walls on walls and objects on objects of their class against
/// what chance would do, walls in free space of the other map, and a prior that spreads over all
/// distinguishable transforms. Without two grids the objects alone decide, and four pairs are needed.
/// Nothing, with the reason in words, when no transform, or more than one, explains the maps.
Outcome<MapAlignment> alignMaps(const CSemanticMap& a, const CSemanticMap& b,
                                const MapAlignmentOptions& options = {});

/// The map in another frame: objects with the transform's uncertainty, poses, and the grid on a lattice that
/// continues that of `lattice` (its own resolution and zero without one).
CSemanticMap movedMap(const CSemanticMap& b, const MapAlignment& alignment,
                      const mrpt::maps::COccupancyGridMap2D* lattice);

}  // namespace roomgraph
