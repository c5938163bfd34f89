// SPDX-License-Identifier: BSD-3-Clause
// Constellation match checked by scan returns on walls; union of two landmark sets.
#include "roomgraph/estimation/map_anchor.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/association/landmark_identity.h"

namespace roomgraph {
namespace {

constexpr double kMinOnWalls = 0.5;  // the rest may be people and moved objects
constexpr double kOccupied = 0.4;    // MRPT's cells hold the probability of being free

bool occupiedNear(const mrpt::maps::COccupancyGridMap2D& grid, const Eigen::Vector2d& point, double reach_m) {
  const int x = grid.x2idx(point.x()), y = grid.y2idx(point.y());
  const int cells = std::max(1, static_cast<int>(std::lround(reach_m / grid.getResolution())));
  for (int i = x - cells; i <= x + cells; ++i)
    for (int j = y - cells; j <= y + cells; ++j)
      if (i >= 0 && j >= 0 && i < static_cast<int>(grid.getSizeX()) &&
          j < static_cast<int>(grid.getSizeY()) && grid.getCell(i, j) < kOccupied)
        return true;
  return false;
}

}  // namespace

double shareOnWalls(const mrpt::maps::COccupancyGridMap2D& grid, const std::vector<Eigen::Vector2d>& points,
                    double reach_m) {
  if (points.empty()) return 0;
  const auto hits = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
    return occupiedNear(grid, point, reach_m);
  });
  return static_cast<double>(hits) / static_cast<double>(points.size());
}

std::optional<Pose2> MapAnchor::find(const std::vector<Landmark>& seen,
                                     const std::vector<Eigen::Vector2d>& returns) const {
  const bool checked = map_.occupancy && !returns.empty();
  ConstellationOptions rule = rule_;
  if (!checked) ++rule.min_pairs;
  const auto match = matchConstellation(seen, map_.landmarks, rule);
  if (!match) return std::nullopt;
  if (!checked) return match->map_from_query;
  std::vector<Eigen::Vector2d> in_map;
  for (const auto& point : returns) in_map.push_back(match->map_from_query * point);
  if (shareOnWalls(*map_.occupancy, in_map) < kMinOnWalls) return std::nullopt;
  return match->map_from_query;
}

void MapAnchor::add(const Scan& scan) {
  if (!recognised_) scan_ = scan;
}

std::optional<Pose2> MapAnchor::recognise(const std::vector<Landmark>& seen, const KeyPoses& poses) {
  if (recognised_) return std::nullopt;
  std::vector<Eigen::Vector2d> returns;
  if (scan_) {
    const Pose3 world_from_robot = poses.at(scan_->t);
    for (const auto& point : scan_->pointsInRobot()) returns.push_back((world_from_robot * point).head<2>());
  }
  const auto map_from_world = find(seen, returns);
  recognised_ = map_from_world.has_value();
  return map_from_world;
}

std::vector<Landmark> joined(std::vector<Landmark> landmarks, const std::vector<Landmark>& earlier) {
  const std::vector<Landmark> now = landmarks;
  LandmarkIdentity identity;
  for (const auto& landmark : now) identity.reserve(landmark.id);
  for (Landmark old : earlier) {
    const double near = old.shape.horizontalExtent() / 2;
    const bool there = std::any_of(now.begin(), now.end(), [&](const Landmark& landmark) {
      return landmark.class_name == old.class_name &&
             (landmark.position - old.position).head<2>().norm() < near;
    });
    if (there) continue;
    old.id = identity.create();
    landmarks.push_back(old);
  }
  return landmarks;
}

}  // namespace roomgraph
