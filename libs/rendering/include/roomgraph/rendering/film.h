// SPDX-License-Identifier: BSD-3-Clause
// A film of how a map came to be: the robot on its way, and what it had seen so far.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/figure.h"
#include "roomgraph/rendering/snapshot.h"

namespace roomgraph {

/// Landmarks that were measured at one instant.
struct MapSighting {
  double t = 0;  ///< s
  std::vector<LandmarkId> landmarks;
};

struct FilmOptions {
  SnapshotOptions picture;                   ///< of every frame; sizes are rounded down to even ones
  FigureStyle style = FigureStyle::kScreen;  ///< kPaper: from above only
  double fps = 25;
  double seconds = 20;  ///< that the way takes in the film
  double speed = 0;     ///< times real time instead, when above 0
};

/// What a film shows at its end was made of this.
struct FilmResult {
  int frames = 0;             ///< written
  int asked_for = 0;          ///< fewer were written when it was stopped
  int width = 0, height = 0;  ///< px
};

/// Calls after every frame with the share done in [0, 1]; true ends the film there.
using FilmProgress = std::function<bool(double share)>;

/// Writes the film: .mp4, .webm, .avi by the ending; anything else is a folder of numbered PNGs. The final
/// trajectory grows, with the robot at its end; landmarks appear at their first sighting; cells of the grid
/// appear when they first lie in the robot's line of sight (the files of a run do not say when they were
/// measured); lines lead to what is measured at the moment. Pauses of the recording are shortened to a
/// second. Stopped early it is a shorter film. Throws RunError: no trajectory, this OpenCV has no such codec
/// (the message names the folder instead), the folder has frames already, it cannot be written.
FilmResult writeFilm(const CSemanticMap& map, const std::vector<MapSighting>& sightings,
                     const ObjectDatabase& database, const FilmOptions& options,
                     const std::filesystem::path& place, const FilmProgress& progress);

/// The sightings of associations.jsonl, in the order of time. Throws InputError with file and line.
std::vector<MapSighting> readSightings(const std::filesystem::path& associations);

}  // namespace roomgraph
