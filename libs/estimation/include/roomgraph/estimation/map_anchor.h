// SPDX-License-Identifier: BSD-3-Clause
// Localisation in an earlier map by the constellation of objects, confirmed by a scan.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/association/constellation.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// An earlier map in whose frame the run is to be: the constellation of the objects seen so far gives the transform,
/// the latest scan in the map's grid verifies it (method.md sec. 4 and 6).
class MapAnchor {
 public:
  MapAnchor(CSemanticMap map, const ConstellationOptions& rule) : map_(std::move(map)), rule_(rule) {}

  const CSemanticMap& map() const { return map_; }
  /// Whether the map was recognised: the world is now the map's frame.
  bool recognised() const { return recognised_; }

  /// The latest scan, kept until the map is recognised.
  void add(const Scan& scan);

  /// map_from_world at the moment at which the map is recognised, once; the caller moves its world there. Nothing
  /// when the objects do not match those of the map, or the latest scan contradicts it. Without a scan or a grid one
  /// more object than usual must agree. There must be a key pose.
  std::optional<Pose2> recognise(const std::vector<Landmark>& seen, const KeyPoses& poses);

 private:
  std::optional<Pose2> find(const std::vector<Landmark>& seen, const std::vector<Eigen::Vector2d>& returns) const;

  CSemanticMap map_;
  ConstellationOptions rule_;
  std::optional<Scan> scan_;
  bool recognised_ = false;
};

/// Share of the points that lie within `reach_m` of an occupied cell; 0 without points.
double shareOnWalls(const mrpt::maps::COccupancyGridMap2D& grid, const std::vector<Eigen::Vector2d>& points,
                    double reach_m = 0.15);

/// The landmarks, and those of an earlier map where none of their class is now; these get new ids.
std::vector<Landmark> joined(std::vector<Landmark> landmarks, const std::vector<Landmark>& earlier);

}  // namespace roomgraph
