// SPDX-License-Identifier: BSD-3-Clause
// Checks of grid size, landmarks and trajectory of a loaded map.
#include "map_check.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/plausible_pose.h"

namespace roomgraph {
namespace {

constexpr double kLargestSize_m = 1000;
constexpr double kRounding = 1e-6;
constexpr double kMostWeight = 1e9;

std::string problemOf(const mrpt::maps::COccupancyGridMap2D& grid) {
  const auto cells = std::uint64_t{grid.getSizeX()} * grid.getSizeY();
  if (cells != grid.getRawMap().size()) return "its grid's size does not fit its cells";
  const double resolution = static_cast<double>(grid.getResolution());
  if (!(resolution > 1e-4) || !(resolution < 100)) return "its grid's resolution is not in (0.0001, 100) m";
  const auto fits = [&](float low, float high, unsigned count) {
    const double span = static_cast<double>(high) - static_cast<double>(low);
    return std::abs(low) < kFarthest_m && std::abs(span / resolution - count) < 1 + 0.01 * count;
  };
  if (!fits(grid.getXMin(), grid.getXMax(), grid.getSizeX()) ||
      !fits(grid.getYMin(), grid.getYMax(), grid.getSizeY()))
    return "its grid's borders do not fit its cells";
  return "";
}

std::string problemOf(const Landmark& landmark) {
  if (!(landmark.position.norm() < kFarthest_m)) return "position is not finite or too far away";
  if (!std::isfinite(landmark.yaw)) return "yaw is not finite";
  for (const double size : {landmark.shape.width, landmark.shape.depth, landmark.shape.height})
    if (!(size >= 0 && size < kLargestSize_m)) return "size is not in [0, 1000) m";
  if (!landmark.covariance.allFinite()) return "covariance is not finite";
  if (!(landmark.existence >= 0 && landmark.existence <= 1 + kRounding)) return "existence is not in [0, 1]";
  for (const auto& [name, probability] : landmark.class_posterior)
    if (!(probability >= 0 && probability <= 1 + kRounding)) return "probability of a class is not in [0, 1]";
  return "";
}

bool isPose(const StampedPose& stamped) {
  return std::isfinite(stamped.t) && roomgraph::problemOf(stamped.pose, 1e-3).empty();
}

}  // namespace

std::string problemOf(const CSemanticMap& map) {
  if (map.occupancy)
    if (auto problem = problemOf(*map.occupancy); !problem.empty()) return problem;
  for (const auto& landmark : map.landmarks)
    if (const auto problem = problemOf(landmark); !problem.empty())
      return "landmark " + std::to_string(landmark.id.value) + ": " + problem;
  const auto& poses = map.world_from_robot;
  if (!std::all_of(poses.begin(), poses.end(), isPose)) return "a pose of its trajectory is none";
  const auto later = [](const StampedPose& a, const StampedPose& b) { return !(a.t < b.t); };
  if (std::adjacent_find(poses.begin(), poses.end(), later) != poses.end())
    return "its trajectory is not in order of time";
  for (const auto& [id, span] : map.seen)
    if (!std::isfinite(span.first) || !std::isfinite(span.last) || span.last < span.first)
      return "landmark " + std::to_string(id.value) + ": last seen before it was first seen";
  for (const auto& view : map.views)
    if (!isPose({view.t, view.world_from_camera})) return "the pose of a view is none";
  for (const auto& [id, weight] : map.weights)
    if (!(weight >= 0 && weight < kMostWeight))
      return "landmark " + std::to_string(id.value) + ": the weight of its sightings is not in [0, 1e9)";
  return "";
}

}  // namespace roomgraph
