// SPDX-License-Identifier: BSD-3-Clause
// Files of a run, each on its own, and their lines put to the states by time.
#include "roomgraph/viewer/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "roomgraph/core/text_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/report/graph_closures.h"
#include "run_lines.h"

namespace roomgraph {
namespace {

std::shared_ptr<const ShownPath> shownPath(const CSemanticMap& map) {
  auto path = std::make_shared<ShownPath>();
  for (const auto& pose : map.world_from_robot) path->push_back(toShown(pose));
  return path;
}

ViewState lastState(const CSemanticMap& map) {
  ViewState state;
  state.record = static_cast<int>(map.world_from_robot.size());
  if (!map.world_from_robot.empty()) {
    state.t = map.world_from_robot.back().t;
    state.world_from_robot = map.world_from_robot.back().pose;
  }
  state.planar = map.planar;
  state.grid = map.occupancy;
  state.path = shownPath(map);
  auto landmarks = std::make_shared<ShownLandmarks>();
  for (const auto& landmark : map.landmarks)
    landmarks->push_back(std::make_shared<const ShownLandmark>(ShownLandmark{landmark, true, {}}));
  state.landmarks = landmarks;
  return state;
}

/// Landmarks come into view in the order in which they were first seen.
class Appearance {
 public:
  Appearance(const ShownLandmarks& all, const std::vector<ShownSighting>& sightings) : all_(all) {
    for (const auto& sighting : sightings) first_.emplace(sighting.landmark, sighting.t);  // in order of time
    for (const auto& shown : all) {
      const auto seen = first_.find(shown->landmark.id);
      if (seen != first_.end()) times_.push_back(seen->second);
    }
    std::sort(times_.begin(), times_.end());
  }
  /// Shared by all times between two appearances. One that was never seen is of an earlier map.
  std::shared_ptr<const ShownLandmarks> until(double t) {
    const auto count = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
    if (newest_ && count == count_) return newest_;
    auto landmarks = std::make_shared<ShownLandmarks>();
    for (const auto& shown : all_) {
      const auto seen = first_.find(shown->landmark.id);
      if (seen == first_.end() || seen->second <= t) landmarks->push_back(shown);
    }
    count_ = count;
    return newest_ = landmarks;
  }

 private:
  const ShownLandmarks& all_;
  std::map<LandmarkId, double> first_;
  std::vector<double> times_;
  std::ptrdiff_t count_ = 0;
  std::shared_ptr<const ShownLandmarks> newest_;
};

ViewStates statesOverTime(const CSemanticMap& map, const ViewState& last, const FrameReports& frames) {
  ViewStates states;
  Appearance appearance(*last.landmarks, *last.all_sightings);
  auto frame = frames.begin();
  std::shared_ptr<const StepReport> newest;
  for (const auto& pose : map.world_from_robot) {
    for (; frame != frames.end() && frame->first <= pose.t + 1e-5; ++frame) newest = frame->second;
    auto state = std::make_shared<ViewState>(last);
    state->record = static_cast<int>(states.size()) + 1;
    state->t = pose.t;
    state->world_from_robot = pose.pose;
    state->landmarks = appearance.until(pose.t);
    state->frame = newest;
    states.push_back(std::move(state));
  }
  if (states.empty()) states.push_back(std::make_shared<const ViewState>(last));
  return states;
}

/// Reads one of the run's files; what is wrong with it becomes a warning.
template <class Value>
Value readOr(const std::filesystem::path& file, std::vector<std::string>& warnings, const std::string& costs,
             const std::function<Value(std::istream&, const std::string&)>& reader) {
  try {
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file)) throw InputError(file.string() + ": cannot be opened");
    return reader(in, file.string());
  } catch (const std::exception& error) {
    warnings.push_back(firstLine(error) + "; without it: no " + costs);
    return {};
  }
}

}  // namespace

ViewStates statesOfMap(const CSemanticMap& map) {
  auto state = std::make_shared<ViewState>(lastState(map));
  state->record = 0;
  return {state};
}

RecordedRun readRecordedRun(const std::filesystem::path& folder) {
  RecordedRun run;
  const CSemanticMap map = loadMap(folder / "map.rgmap");
  ViewState last = lastState(map);
  const auto file = [&](const char* name) { return folder / name; };
  auto& warnings = run.warnings;
  last.landmarks = std::make_shared<const ShownLandmarks>(readOr<ShownLandmarks>(
      file("candidates.json"), warnings, "evidence and no candidates",
      [&](std::istream& in, const std::string& name) { return withCandidates(*last.landmarks, in, name); }));
  if (last.landmarks->empty()) last.landmarks = lastState(map).landmarks;
  last.all_sightings = std::make_shared<const std::vector<ShownSighting>>(readOr<std::vector<ShownSighting>>(
      file("associations.jsonl"), warnings, "sightings", readSightingLines));
  const auto closures = readOr<std::vector<ClosedLoop>>(
      file("graph.g2o"), warnings, "loop closures",
      [](std::istream& in, const std::string&) { return readClosures(in, 0); });
  auto shown = std::make_shared<std::vector<ShownClosure>>();
  for (const auto& closure : closures) shown->push_back({closure.t_a, closure.t_b});
  last.closures = shown;
  const auto frames = readOr<FrameReports>(file("detections.jsonl"), warnings, "boxes", readBoxLines);
  run.views = readOr<std::map<LandmarkId, std::string>>(file("views.jsonl"), warnings, "views of the objects",
                                                        readViewLines);
  const auto summary = readOr<RunSummary>(file("summary.json"), warnings, "camera images", readRunSummary);
  run.recording = summary.recording;
  if (summary.loop_closures > shown->size()) last.loop_closures = summary.loop_closures;
  run.states = statesOverTime(map, last, frames);
  return run;
}

}  // namespace roomgraph
