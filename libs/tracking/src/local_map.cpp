// SPDX-License-Identifier: BSD-3-Clause
// Creation of points, bookkeeping of sightings, covisible keyframes.
#include "local_map.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace roomgraph::tracking {

Observation Keyframe::observation(int feature, const TrackingParameters& parameters) const {
  const auto i = static_cast<std::size_t>(feature);
  return makeObservation(features.pixel(i), features.places[i].octave, features.depth[i], parameters);
}

std::int64_t LocalMap::createPoint(int keyframe_index, int feature) {
  const auto id = static_cast<std::int64_t>(points.size());
  const auto& frame = keyframe(keyframe_index);
  const auto i = static_cast<std::size_t>(feature);
  const Eigen::Vector2d pixel = frame.features.pixel(i);
  MapPoint& created = points.add();
  created.position =
      frame.odom_from_camera * frame.camera.backProject(pixel.x(), pixel.y(), frame.features.depth[i]);
  created.visible = created.found = 1;
  addSighting(id, keyframe_index, feature);
  return id;
}

void LocalMap::addSighting(std::int64_t id, int keyframe_index, int feature) {
  auto& p = point(id);
  auto& frame = keyframe(keyframe_index);
  const auto i = static_cast<std::size_t>(feature);
  p.sightings.push_back({keyframe_index, feature});
  frame.points[i] = id;
  looksAsSeenLast(p);
}

// What it is known again by.
void LocalMap::looksAsSeenLast(MapPoint& p) {
  const auto& [keyframe_index, feature] = p.sightings.back();
  const auto& frame = keyframe(keyframe_index);
  const auto i = static_cast<std::size_t>(feature);
  const Eigen::Vector3d ray = p.position - frame.odom_from_camera.translation();
  p.descriptor = frame.features.descriptors[i];
  p.octave = frame.features.places[i].octave;
  p.distance = ray.norm();
  p.direction = ray.normalized();
}

void LocalMap::removeSighting(std::int64_t id, int keyframe_index) {
  auto& sightings = point(id).sightings;
  const auto it = std::find_if(sightings.begin(), sightings.end(),
                               [&](const Sighting& s) { return s.keyframe == keyframe_index; });
  if (it == sightings.end()) return;
  keyframe(keyframe_index).points[static_cast<std::size_t>(it->feature)] = -1;
  const bool latest = std::next(it) == sightings.end();
  sightings.erase(it);
  if (sightings.empty())
    points.release(static_cast<std::size_t>(id));
  else if (latest)
    looksAsSeenLast(point(id));
}

void LocalMap::erase(std::int64_t id) {
  for (const auto& s : point(id).sightings) keyframe(s.keyframe).points[static_cast<std::size_t>(s.feature)] = -1;
  points.release(static_cast<std::size_t>(id));
}

void LocalMap::giveUp(int keyframe_index, int older) {
  const auto ids = keyframe(keyframe_index).points;
  for (const auto id : ids)
    if (id >= 0) removeSighting(id, keyframe_index);
  Keyframe& it = keyframe(keyframe_index);
  it = Keyframe{.t = it.t,
                .segment = it.segment,
                .origin = it.origin,
                .camera = it.camera,
                .odom_from_camera = it.odom_from_camera,
                .shown_by = older};
}

std::vector<std::pair<int, int>> LocalMap::covisible(const std::vector<std::int64_t>& ids) const {
  std::map<int, int> votes;
  for (const auto id : ids)
    if (id >= 0)
      for (const auto& s : point(id).sightings) ++votes[s.keyframe];
  std::vector<std::pair<int, int>> out;
  for (const auto& [index, count] : votes) out.emplace_back(count, index);
  std::sort(out.rbegin(), out.rend());
  return out;
}

std::vector<std::int64_t> LocalMap::pointsOf(const std::vector<int>& keyframe_indices) const {
  std::vector<std::int64_t> ids;
  for (const int index : keyframe_indices)
    for (const auto id : keyframe(index).points)
      if (id >= 0) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace roomgraph::tracking
