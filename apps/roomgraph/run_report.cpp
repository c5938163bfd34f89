// SPDX-License-Identifier: BSD-3-Clause
// Formatting of the summaries of a run.
#include "run_report.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>

#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/rendering/snapshot.h"

namespace roomgraph {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string describeEarlier(const EarlierMap& earlier) {
  if (!earlier.recognised)
    return "relocalised in the earlier map: no; the map is not continued, and all results are in the run's "
           "own frame" +
           (earlier.missing.empty() ? "" : " (the earlier map lacks " + earlier.missing + ")") + "\n";
  return format("relocalised in the earlier map: yes, after %.1f s, by %s; ", earlier.after_s,
                earlier.by.c_str()) +
         format("of its objects %d seen again, %d not seen, %d gone; %d new\n", earlier.common,
                earlier.unseen, earlier.vanished, earlier.appeared);
}

}  // namespace

std::string describeProgress(const ReplayState& state, double elapsed_s) {
  return format("%.1f s replayed, %.0f records/s, %.1f x real time", state.seconds(),
                state.records / std::max(elapsed_s, 1e-9), state.seconds() / std::max(elapsed_s, 1e-9));
}

std::string describeObjects(const std::vector<Landmark>& landmarks) {
  std::map<std::string, int> classes;
  for (const auto& landmark : landmarks) ++classes[landmark.class_name];
  std::vector<std::pair<int, std::string>> ordered;
  for (const auto& [name, count] : classes) ordered.emplace_back(-count, name);
  std::sort(ordered.begin(), ordered.end());
  std::vector<std::string> words;
  for (const auto& [count, name] : ordered) words.push_back(std::to_string(-count) + " " + name);
  const std::string total =
      landmarks.size() == 1 ? "1 object" : std::to_string(landmarks.size()) + " objects";
  return total + (words.empty() ? "" : ": " + join(words));
}

std::string describeRun(const SlamResult& result, const ReplayState& replayed, const ReadStatistics& read,
                        double elapsed_s) {
  const auto& counts = result.counts;
  std::string text =
      format("%d frames (%d not tracked), %d scans (%d not matched), %d odometry readings; ", counts.frames,
             counts.frames_lost, counts.scans, counts.scans_unmatched, counts.odometry) +
      format("%d key poses, %d loop closures\n", counts.key_poses, counts.loop_closures);
  text += describeObjects(result.map.landmarks) + "\n";
  if (result.earlier) text += describeEarlier(*result.earlier);
  text += format("%.1f s of data in %.1f s\n", replayed.seconds(), elapsed_s);
  for (const auto& [reason, count] : counts.reasons) text += format("  %d x ", count) + reason + "\n";
  for (const auto& [reason, count] : read.skipped) text += format("  skipped %d x ", count) + reason + "\n";
  return text;
}

bool drawSnapshot(const CSemanticMap& map, const ObjectDatabase& database, const std::filesystem::path& png) {
  try {
    renderSnapshot(map, database, {.title = map.origin}, png);
    return true;
  } catch (const NoRenderer& error) {
    std::cerr << "roomgraph: warning: no snapshot.png: " << error.what()
              << " (--no-snapshot: not asked for)\n";
  } catch (const RunError&) {
    throw;
  } catch (const std::exception& error) {
    std::cerr << "roomgraph: warning: no snapshot.png: " << firstLine(error) << "\n";
  }
  return false;
}

}  // namespace roomgraph
