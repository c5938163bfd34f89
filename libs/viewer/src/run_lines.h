// SPDX-License-Identifier: BSD-3-Clause
// What a viewer needs of the JSON files of a run.
#pragma once

#include <istream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

// Each throws InputError naming `name`, line or entry, and cause.

/// Reports with nothing but time and boxes, in order of time.
using FrameReports = std::vector<std::pair<double, std::shared_ptr<const StepReport>>>;

/// associations.jsonl, in order of time.
std::vector<ShownSighting> readSightingLines(std::istream& lines, const std::string& name);
/// detections.jsonl.
FrameReports readBoxLines(std::istream& lines, const std::string& name);
/// views.jsonl: JPEG by landmark.
std::map<LandmarkId, std::string> readViewLines(std::istream& lines, const std::string& name);
/// The landmarks of the map with the evidence of candidates.json, then the candidates that are not in the
/// map.
ShownLandmarks withCandidates(const ShownLandmarks& mapped, std::istream& in, const std::string& name);
struct RunSummary {
  std::string recording;          ///< as it was named
  std::size_t loop_closures = 0;  ///< found
};
/// summary.json.
RunSummary readRunSummary(std::istream& in, const std::string& name);

}  // namespace roomgraph
