// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph map join`: one result of runs of overlapping pieces of a recording.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "map_commands.h"
#include "program.h"
#include "roomgraph/catalogue/run_result.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/output_folder.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/maptools/piece_union.h"
#include "roomgraph/pipeline/run_output.h"
#include "roomgraph/rendering/snapshot.h"
#include "run_report.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct MapJoinArguments {
  std::vector<std::string> runs;
  std::string output;
  bool quiet = false, no_snapshot = false;
};

/// All pieces in the frame of the first one.
struct JoinedPieces {
  CSemanticMap map;
  std::optional<std::vector<StampedPose>> camera;  ///< nothing: a piece has no path of a camera
  ordered_json pieces = ordered_json::array();
};

std::optional<std::vector<StampedPose>> cameraPathOf(const fs::path& run) {
  const fs::path file = run / "trajectory_camera.tum";
  std::error_code none;
  if (fs::file_size(file, none) == 0 || none) return std::nullopt;
  const Trajectory path = readTrajectory(file).trajectory;
  return std::vector<StampedPose>(path.poses().begin(), path.poses().end());
}

std::string describePiece(const std::string& run, const PieceUnion& joined) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "moved by %.2f, %.2f m and turned by %.1f deg, by %s; %d poses in common, which differ by %.3f m",
      joined.a_from_b.x, joined.a_from_b.y, joined.a_from_b.yaw * 180 / std::numbers::pi,
      joined.by_maps ? "objects and walls" : "the common path alone", joined.paths.poses, joined.paths.rms_m);
  return run + ": " + text + (joined.why_not.empty() ? "" : " (" + joined.why_not + ")") + "\n";
}

ordered_json pieceJson(const std::string& run, const PieceUnion& joined) {
  return {{"run", run},
          {"x", joined.a_from_b.x},
          {"y", joined.a_from_b.y},
          {"yaw", joined.a_from_b.yaw},
          {"by", joined.by_maps ? "maps" : "path"},
          {"why_not_maps", joined.why_not},
          {"common_poses", joined.paths.poses},
          {"rms_m", joined.paths.rms_m}};
}

JoinedPieces joinPieces(const MapJoinArguments& a) {
  JoinedPieces all;
  all.map = loadMap(fs::path(a.runs.front()) / "map.rgmap");
  all.camera = cameraPathOf(a.runs.front());
  all.pieces.push_back({{"run", a.runs.front()}, {"x", 0}, {"y", 0}, {"yaw", 0}});
  for (std::size_t i = 1; i < a.runs.size(); ++i) {
    const std::string& run = a.runs[i];
    auto joined = unitedPieces(all.map, loadMap(fs::path(run) / "map.rgmap"));
    if (!joined) throw RunError(run + " cannot be joined to what is before it: " + joined.reason());
    all.map = std::move(joined->map);
    if (auto camera = all.camera ? cameraPathOf(run) : std::nullopt) {
      for (auto& stamped : *camera) stamped.pose = toPose3(joined->a_from_b) * stamped.pose;
      all.camera = joinedPaths(*all.camera, *camera);
    } else {
      all.camera.reset();
    }
    all.pieces.push_back(pieceJson(run, *joined));
    if (!a.quiet) std::cout << describePiece(run, *joined);
  }
  all.map.provenance.program = programName();
  return all;
}

// Sums over the pieces: what they have in common was done twice.
ordered_json summaryOf(const MapJoinArguments& a, const JoinedPieces& joined) {
  std::map<std::string, double> counts;
  std::map<std::string, StageTotal> times;
  for (const auto& run : a.runs) {
    const fs::path summary = fs::path(run) / "summary.json";
    constexpr std::string_view kCounts = "run.counts.";
    for (const auto& [name, value] : numbersOf(summary, "run"))
      if (name.starts_with(kCounts)) counts[name.substr(kCounts.size())] += value;
    for (const auto& [stage, total] : stageTotalsOf(summary)) {
      auto& sum = times[stage];
      sum.calls += total.calls;
      sum.total_ms += total.total_ms;
      sum.max_ms = std::max(sum.max_ms, total.max_ms);
    }
  }
  counts["landmarks"] = static_cast<double>(joined.map.landmarks.size());
  ordered_json out{
      {"input", joined.map.origin},       {"version", kVersion},     {"revision", kRevision},
      {"command", commandLine()},         {"pieces", joined.pieces}, {"counts", ordered_json::object()},
      {"timings", ordered_json::object()}};
  for (const auto& [name, value] : counts) out["counts"][name] = std::llround(value);
  for (const auto& [stage, total] : times)
    out["timings"][stage] = {
        {"calls", total.calls},
        {"mean_ms", total.total_ms / static_cast<double>(std::max<std::int64_t>(1, total.calls))},
        {"max_ms", total.max_ms},
        {"total_ms", total.total_ms}};
  return out;
}

std::string tumText(const std::vector<StampedPose>& path) {
  std::ostringstream text;
  writeTum(text, path);
  return text.str();
}

void joinRuns(const MapJoinArguments& a) {
  if (a.runs.size() < 2) throw ConfigError("name at least two runs");
  std::vector<fs::path> inputs;
  for (const auto& run : a.runs) inputs.push_back(fs::path(run) / "map.rgmap");
  OutputFolder files(a.output,
                     {"trajectory.tum", "trajectory_camera.tum", "landmarks.json", "map.pgm", "map.yaml",
                      "map.rgmap", "snapshot.png", "summary.json"},
                     inputs);
  const JoinedPieces joined = joinPieces(a);
  const CSemanticMap& map = joined.map;
  writeFileAtomically(files.pending("trajectory.tum"), tumText(map.world_from_robot));
  if (joined.camera) writeFileAtomically(files.pending("trajectory_camera.tum"), tumText(*joined.camera));
  saveLandmarksJson(map.landmarks, files.pending("landmarks.json"),
                    {map.origin, programName(), map.seen, {}});
  if (map.occupancy) saveOccupancyRos(*map.occupancy, files.pending("map.pgm").replace_extension());
  saveMap(map, files.pending("map.rgmap"));
  if (!a.no_snapshot) {
    const ObjectDatabase database = databaseOf(map, (fs::path(a.runs.front()) / "map.rgmap").string(), "");
    drawSnapshot(map, database, files.pending("snapshot.png"));
  }
  writeFileAtomically(
      files.pending("summary.json"),
      summaryOf(a, joined).dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  files.publish();
  std::cout << a.output << ": " << a.runs.size() << " pieces, " << describeObjects(map.landmarks) << "\n";
}

}  // namespace

void addMapJoin(CLI::App& parent) {
  auto a = std::make_shared<MapJoinArguments>();
  auto* command =
      parent.add_subcommand("join", "One result of runs of pieces of a recording that overlap in time");
  command->add_option("RUN", a->runs, "folders of the runs ('run --from --until'), in order of time")
      ->required();
  command->add_option("-o,--output", a->output, "folder to write")->required();
  command->add_flag("--quiet", a->quiet, "not a line for each piece");
  command->add_flag("--no-snapshot", a->no_snapshot, "do not render snapshot.png");
  command->footer(
      "Example:\n"
      "  roomgraph run lab.rawlog -o out/1 --until 320\n"
      "  roomgraph run lab.rawlog -o out/2 --from 300\n"
      "  roomgraph map join out/1 out/2 -o out/whole\n"
      "The common time tells where a piece lies, objects and walls correct it; pieces whose paths do not "
      "agree are refused "
      "(exit code 1). 'roomgraph batch --split' does all of it.");
  command->callback([a] { joinRuns(*a); });
}

}  // namespace roomgraph
