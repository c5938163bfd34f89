// SPDX-License-Identifier: BSD-3-Clause
// States of a finished run from the files that it wrote, or of a map alone.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

/// What the folder of a run tells over time.
struct RecordedRun {
  ViewStates states;                        ///< one for each pose of its trajectory; at least one
  std::filesystem::path recording;          ///< what it was made of; empty: not known
  std::map<LandmarkId, std::string> views;  ///< of each landmark the picture in which it was seen best: JPEG
  std::vector<std::string> warnings;        ///< files that are missing or broken, and what that costs
};

/// Map, trajectory, landmarks, closures, boxes and associations of a folder that `run` wrote
/// (docs/formats.md). Throws InputError when it has no map.rgmap, or that cannot be read; whatever else is
/// wrong is a warning.
RecordedRun readRecordedRun(const std::filesystem::path& folder);

/// One state: the map at its end.
ViewStates statesOfMap(const CSemanticMap& map);

}  // namespace roomgraph
