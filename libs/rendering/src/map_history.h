// SPDX-License-Identifier: BSD-3-Clause
// MapHistory: the part of a finished map that was there at an instant.
#pragma once

#include <map>
#include <vector>

#include "map_picture.h"
#include "roomgraph/rendering/film.h"

namespace roomgraph {

/// A finished map in time: places and shapes are the final ones, what is there grows.
class MapHistory {
 public:
  /// The map outlives the history.
  MapHistory(const CSemanticMap& map, std::vector<MapSighting> sightings);

  /// Path until t, landmarks whose first sighting is not after t, cells that came into sight by then.
  /// Landmarks of which no sighting is known (an earlier map had them) are there from the start.
  CSemanticMap at(double t) const;
  /// Landmarks of the map that were measured in (t - span_s, t], each once.
  std::vector<LandmarkId> inSight(double t, double span_s) const;

 private:
  const CSemanticMap& map_;
  std::vector<MapSighting> sightings_;  ///< by time
  std::map<LandmarkId, double> first_;
  std::vector<double> cell_times_;
};

/// Times (s) of the frames of a film along a path, the first at its beginning and the last at its end:
/// equally spaced but for pauses of more than a second, which take one. At `per_frame_s` of the recording
/// each; at least two.
std::vector<double> frameTimes(const std::vector<StampedPose>& path, double per_frame_s);
/// Seconds of the path with pauses shortened so.
double timeOnTheWay(const std::vector<StampedPose>& path);

}  // namespace roomgraph
