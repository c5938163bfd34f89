// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph map diff` and `roomgraph map merge`: two maps of one place.
#include <cstdio>
#include <iostream>
#include <memory>
#include <numbers>

#include "map_commands.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/maptools/map_alignment.h"
#include "roomgraph/maptools/map_difference.h"
#include "roomgraph/maptools/map_union.h"
#include "run_report.h"

namespace roomgraph {
namespace {

struct MapDiffArguments {
  std::string before, after, svg, json;
  bool same_frame = false;
};

struct MapMergeArguments {
  std::vector<std::string> maps;
  std::string output;
  bool same_frame = false;
};

std::string describeAlignment(const MapAlignment& alignment) {
  char text[200];
  const Pose2& pose = alignment.a_from_b;
  std::snprintf(
      text, sizeof text,
      "moved by %.2f, %.2f m and turned by %.1f deg; %d objects and %.0f %% of %.0f m of walls agree; "
      "probability %.3f",
      pose.x, pose.y, pose.yaw * 180 / std::numbers::pi, alignment.pairs, 100 * alignment.explained,
      alignment.walls_m, alignment.probability);
  return text;
}

// The second map in the frame of the first; a RunError when that is not certain.
CSemanticMap inFrameOf(const CSemanticMap& a, const CSemanticMap& b, const std::string& file_a,
                       const std::string& file_b, bool same_frame) {
  MapAlignmentOptions options;
  options.same_frame = same_frame;
  const auto alignment = alignMaps(a, b, options);
  if (!alignment)
    throw RunError(file_b + " has no certain place in " + file_a + ": " + alignment.reason() +
                   "; --same-frame when both are in one frame");
  if (!same_frame) std::cout << file_b << ": " << describeAlignment(*alignment) << "\n";
  return movedMap(b, *alignment, a.occupancy.get());
}

std::string describeDifference(const ObjectDifference& one) {
  const Landmark& object = one.before ? *one.before : *one.after;
  char text[200];
  int length =
      std::snprintf(text, sizeof text, "%-9s %5.2f  %-16s %3lld  at %6.2f, %6.2f",
                    toString(one.change).c_str(), one.probability, object.class_name.substr(0, 40).c_str(),
                    static_cast<long long>(object.id.value), object.position.x(), object.position.y());
  const auto rest = sizeof text - static_cast<std::size_t>(length);
  if (one.before && one.after && one.change == ObjectChange::kMoved)
    std::snprintf(text + length, rest, " -> %6.2f, %6.2f", one.after->position.x(), one.after->position.y());
  if (one.change == ObjectChange::kUnsure)
    std::snprintf(text + length, rest, "  only in the %s map; %.0f %% of its place seen in the other",
                  one.before ? "first" : "second", 100 * one.seen);
  return text;
}

void diffMaps(const MapDiffArguments& a) {
  for (const auto& output : {a.svg, a.json})
    if (!output.empty()) requireOther(output, {a.before, a.after});
  const CSemanticMap before = loadMap(a.before);
  const CSemanticMap after = inFrameOf(before, loadMap(a.after), a.before, a.after, a.same_frame);
  const auto difference = differenceOf(before, after);
  if (!a.json.empty()) writeFileAtomically(a.json, differenceJson(difference));
  if (!a.svg.empty()) writeFileAtomically(a.svg, differenceSvg(before, after, difference));
  int stayed = 0;
  for (const auto& one : difference) {
    stayed += one.change == ObjectChange::kStayed;
    if (one.change != ObjectChange::kStayed) std::cout << describeDifference(one) << "\n";
  }
  std::cout << stayed << (stayed == 1 ? " object" : " objects") << " stayed\n";
}

// A map that goes on with another one holds all of it.
void requireNoneTwice(const std::vector<CSemanticMap>& maps, const std::vector<std::string>& files) {
  for (std::size_t i = 0; i < maps.size(); ++i)
    for (std::size_t j = 0; j < maps.size(); ++j)
      if (i != j && continues(maps[i], maps[j]))
        throw InputError(files[i] + " goes on with " + files[j] + " ('run --map') and holds all of it: merged, it would count twice");
}

void mergeMaps(const MapMergeArguments& a) {
  if (a.maps.size() < 2) throw ConfigError("name at least two maps");
  requireOther(a.output, {a.maps.begin(), a.maps.end()});
  std::vector<CSemanticMap> maps;
  for (const auto& file : a.maps) maps.push_back(loadMap(file));
  requireNoneTwice(maps, a.maps);
  CSemanticMap all = maps.front();
  for (std::size_t i = 1; i < maps.size(); ++i) {
    const CSemanticMap next = inFrameOf(all, maps[i], a.maps.front(), a.maps[i], a.same_frame);
    all = unitedMaps(all, next, differenceOf(all, next));
  }
  all.provenance.program = programName();
  saveMap(all, a.output);
  std::cout << a.output << ": " << describeObjects(all.landmarks) << "\n";
}

}  // namespace

void addMapDiff(CLI::App& parent) {
  auto a = std::make_shared<MapDiffArguments>();
  auto* command = parent.add_subcommand("diff", "Objects that appeared, vanished or moved between two maps");
  command->add_option("BEFORE", a->before, "earlier map.rgmap")->required();
  command->add_option("AFTER", a->after, "later map.rgmap")->required();
  command->add_option("--svg", a->svg, "drawing of the changes to write");
  command->add_option("--json", a->json, "all objects with their change to write");
  command->add_flag("--same-frame", a->same_frame,
                    "both maps are in one frame ('run --map'): do not align them");
  command->footer(
      "Example:\n  roomgraph map diff monday/map.rgmap friday/map.rgmap --svg week.svg --json week.json\n"
      "Places are in the frame of BEFORE. Maps that cannot be aligned with certainty are refused (exit code "
      "1).");
  command->callback([a] { diffMaps(*a); });
}

void addMapMerge(CLI::App& parent) {
  auto a = std::make_shared<MapMergeArguments>();
  auto* command = parent.add_subcommand("merge", "One map of several sessions, in the frame of the first");
  command->add_option("MAP", a->maps, "maps, in order of time")->required();
  command->add_option("-o,--output", a->output, "map to write")->required();
  command->add_flag("--same-frame", a->same_frame, "the maps are in one frame: do not align them");
  command->footer(
      "Example:\n  roomgraph map merge monday/map.rgmap friday/map.rgmap -o flat.rgmap\n"
      "Maps that cannot be aligned with certainty are refused (exit code 1), and a map together with one that goes on with it\n"
      "('run --map'), which holds all of it already.");
  command->callback([a] { mergeMaps(*a); });
}

}  // namespace roomgraph
