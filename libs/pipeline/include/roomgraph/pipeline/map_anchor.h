// SPDX-License-Identifier: BSD-3-Clause
// Localisation in an earlier map by the constellation of objects, confirmed by a scan.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/association/constellation.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// A map made earlier, in whose frame a run is to be: the constellation of the objects seen so far says where
/// it lies, the latest scan against the map's grid confirms it (method.md sec. 4 and 6).
class MapAnchor {
 public:
  MapAnchor(CSemanticMap map, const ConstellationOptions& rule) : map_(std::move(map)), rule_(rule) {}

  const CSemanticMap& map() const { return map_; }

  /// map_from_world, or nothing when the objects do not lie as in the map, or the scan contradicts it.
  /// Without a scan or a grid one more object than usual must agree. `returns`: of the latest scan, in world.
  std::optional<Pose2> find(const std::vector<Landmark>& seen,
                            const std::vector<Eigen::Vector2d>& returns) const;

 private:
  CSemanticMap map_;
  ConstellationOptions rule_;
};

/// Share of the points that lie within `reach_m` of an occupied cell; 0 without points.
double shareOnWalls(const mrpt::maps::COccupancyGridMap2D& grid, const std::vector<Eigen::Vector2d>& points,
                    double reach_m = 0.15);

/// The landmarks, and those of an earlier map where none of their class stands now; these get new ids.
std::vector<Landmark> joined(std::vector<Landmark> landmarks, const std::vector<Landmark>& earlier);

}  // namespace roomgraph
