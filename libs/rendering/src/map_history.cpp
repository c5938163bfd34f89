// SPDX-License-Identifier: BSD-3-Clause
// Parts of a map by time; the clock of a film.
#include "map_history.h"

#include <algorithm>
#include <cmath>

#include "sight_times.h"

namespace roomgraph {
namespace {

constexpr double kLongestPause_s = 1;

double shortened(double seconds) {
  return std::clamp(seconds, 0.0, kLongestPause_s);
}

}  // namespace

MapHistory::MapHistory(const CSemanticMap& map, std::vector<MapSighting> sightings)
    : map_(map), sightings_(std::move(sightings)), cell_times_(sightTimes(map)) {
  std::stable_sort(sightings_.begin(), sightings_.end(),
                   [](const MapSighting& a, const MapSighting& b) { return a.t < b.t; });
  for (const auto& [id, span] : map.seen) first_.emplace(id, span.first);
  for (const auto& sighting : sightings_)
    for (const auto id : sighting.landmarks) {
      const auto [place, added] = first_.emplace(id, sighting.t);
      if (!added) place->second = std::min(place->second, sighting.t);
    }
}

CSemanticMap MapHistory::at(double t) const {
  CSemanticMap part = map_;
  const auto later = [t](const auto& stamped) { return stamped.t > t; };
  auto& path = part.world_from_robot;
  path.erase(std::find_if(path.begin(), path.end(), later), path.end());
  auto& landmarks = part.landmarks;
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(),
                                 [&](const Landmark& landmark) {
                                   const auto first = first_.find(landmark.id);
                                   return first != first_.end() && first->second > t;
                                 }),
                  landmarks.end());
  if (cell_times_.empty()) return part;
  // The finished map keeps its grid: this is a copy.
  part.occupancy = std::make_shared<mrpt::maps::COccupancyGridMap2D>(*map_.occupancy);
  std::size_t index = 0;
  for (int y = 0; y < static_cast<int>(part.occupancy->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(part.occupancy->getSizeX()); ++x)
      if (cell_times_[index++] > t) part.occupancy->setCell(x, y, 0.5f);
  return part;
}

std::vector<LandmarkId> MapHistory::inSight(double t, double span_s) const {
  std::vector<LandmarkId> seen;
  for (const auto& sighting : sightings_) {
    if (sighting.t > t) break;
    if (sighting.t > t - span_s)
      seen.insert(seen.end(), sighting.landmarks.begin(), sighting.landmarks.end());
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  return seen;
}

double timeOnTheWay(const std::vector<StampedPose>& path) {
  double seconds = 0;
  for (std::size_t i = 1; i < path.size(); ++i) seconds += shortened(path[i].t - path[i - 1].t);
  return seconds;
}

std::vector<double> frameTimes(const std::vector<StampedPose>& path, double per_frame_s) {
  const double whole = timeOnTheWay(path);
  const int frames = std::max(2, 1 + static_cast<int>(std::lround(whole / per_frame_s)));
  std::vector<double> times;
  std::size_t next = 1;
  double before = 0;  // of the film's clock at path[next - 1]
  for (int i = 0; i + 1 < frames; ++i) {
    const double wanted = whole * i / (frames - 1);
    while (next + 1 < path.size() && before + shortened(path[next].t - path[next - 1].t) <= wanted) {
      before += shortened(path[next].t - path[next - 1].t);
      ++next;
    }
    const double ahead = next < path.size() ? path[next].t - path[next - 1].t : 0;
    const double share = shortened(ahead) > 0 ? std::min(1.0, (wanted - before) / shortened(ahead)) : 0;
    times.push_back(path[next - 1].t + share * ahead);
  }
  times.push_back(path.back().t);
  return times;
}

}  // namespace roomgraph
