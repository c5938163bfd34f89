// SPDX-License-Identifier: BSD-3-Clause
// New points, fusion with neighbouring keyframes, and culling of unstable points.
#include "keyframe_insertion.h"

#include <algorithm>

#include "matcher.h"

namespace roomgraph::tracking {
namespace {

constexpr int kFuseNeighbours = 4;  // keyframes in which new points are looked for
constexpr double kFuseRadiusPx = 3;
constexpr double kMinFoundRatio = 0.25;  // of the frames that should have seen a point
constexpr int kProbation = 2;            // keyframes within which a point must be seen again

/// Looks for the new keyframe's points in features of its neighbours that have no point yet.
void fuse(LocalMap& map, int index, const std::vector<std::int64_t>& created,
          const TrackingParameters& parameters) {
  int neighbours = 0;
  for (const auto& [shared, other] : map.covisible(map.keyframe(index).points)) {
    if (other == index || map.keyframe(other).origin != map.keyframe(index).origin) continue;
    if (++neighbours > kFuseNeighbours) break;
    Keyframe& keyframe = map.keyframe(other);
    keyframe.features.grid = FeatureGrid(keyframe.features.places, keyframe.camera.width, keyframe.camera.height);
    const Pose3 camera_from_odom = keyframe.odom_from_camera.inverse();
    const ProjectionSearch search{map, keyframe.camera, camera_from_odom, kFuseRadiusPx};
    for (const auto& match : search.match(created, keyframe.features, keyframe.points, parameters))
      map.addSighting(match.point, other, match.feature);
    keyframe.features.grid = {};
  }
}

/// Erases points of the last keyframes that are rarely found again or that one keyframe alone has seen.
void cull(LocalMap& map, int index) {
  for (int recent = std::max(0, index - kProbation - 1); recent < index; ++recent) {
    if (map.keyframe(recent).segment != map.keyframe(index).segment)
      continue;  // it had no chance to be seen again
    const auto ids = map.keyframe(recent).points;
    for (const auto id : ids) {
      if (id < 0) continue;
      const auto& point = map.point(id);
      const bool unproven = index - recent >= kProbation && point.sightings.size() < 2;
      if (unproven || point.found < kMinFoundRatio * point.visible) map.erase(id);
    }
  }
}

}  // namespace

int insertKeyframe(LocalMap& map, Keyframe keyframe, const TrackingParameters& parameters) {
  const int index = static_cast<int>(map.keyframes.size());
  const auto tracked = keyframe.points;
  keyframe.points.assign(keyframe.features.size(), -1);
  keyframe.features.grid = {};
  map.keyframes.push_back(std::move(keyframe));
  std::vector<std::int64_t> created;
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (tracked[i] >= 0)
      map.addSighting(tracked[i], index, static_cast<int>(i));
    else if (map.keyframe(index).features.depth[i] > 0)
      created.push_back(map.createPoint(index, static_cast<int>(i)));
  }
  fuse(map, index, created, parameters);
  cull(map, index);
  return index;
}

}  // namespace roomgraph::tracking
