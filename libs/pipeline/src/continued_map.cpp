// SPDX-License-Identifier: BSD-3-Clause
// Landmarks of two sessions, their spans, and what the summary says of the earlier map.
#include "continued_map.h"

#include "roomgraph/association/landmark_union.h"
#include "roomgraph/estimation/landmark_continuation.h"

namespace roomgraph {
namespace {

std::vector<WeighedLandmark> weighed(const CSemanticMap& map) {
  std::vector<WeighedLandmark> out;
  for (const Landmark& landmark : map.landmarks) out.push_back({landmark, weightOfSightings(map, landmark)});
  return out;
}

void joinSpans(const SeenSpans& earlier, CSemanticMap& map, const SeenSpans& own) {
  map.seen.clear();
  for (const Landmark& landmark : map.landmarks) {
    const auto before = earlier.find(landmark.id), now = own.find(landmark.id);
    if (before != earlier.end()) map.seen[landmark.id] = before->second;
    if (now == own.end()) continue;
    SeenSpan& span = map.seen.try_emplace(landmark.id, now->second).first->second;
    span = {std::min(span.first, now->second.first), std::max(span.last, now->second.last)};
  }
}

}  // namespace

std::string missingIn(const CSemanticMap& map) {
  std::vector<std::string> missing;
  if (map.landmarks.empty()) missing.push_back("objects");
  if (!map.occupancy) missing.push_back("a grid for scans");
  if (map.views.empty()) missing.push_back("views for images (maps written before version 2 have none)");
  std::string out;
  for (const std::string& one : missing) out += (out.empty() ? "" : ", ") + one;
  return out;
}

EarlierMap earlierMapOf(const MapAnchor& anchor, double first_t) {
  EarlierMap out;
  out.missing = missingIn(anchor.map());
  if (!anchor.anchoring()) return out;
  out.recognised = true;
  out.after_s = anchor.anchoring()->t - first_t;
  for (const PlaceSource source : anchor.anchoring()->sources)
    out.by += (out.by.empty() ? "" : " and ") + toString(source);
  return out;
}

void continueMap(const MapAnchor& anchor, const RunForContinuation& run, SlamResult& result) {
  const CSemanticMap& before = anchor.map();
  std::vector<WeighedLandmark> candidates;
  for (const auto& [landmark, evidence] : result.candidates)
    candidates.push_back({landmark, run.objects.landmarks().weightOf(landmark.id)});
  std::vector<LandmarkId> own;
  for (const Landmark& landmark : result.map.landmarks) own.push_back(landmark.id);
  const ContinuationRule rule{run.options.existence.least_probability,
                              run.options.landmarks.exclusive_overlap};
  const ContinuedLandmarks both = continuedLandmarks(
      weighed(before), run.objects.looksAt(before.landmarks, run.database), candidates, own, rule);
  result.map.landmarks.clear();
  result.map.weights.clear();
  for (const auto& [landmark, weight] : both.landmarks) {
    result.map.landmarks.push_back(landmark);
    result.map.weights[landmark.id] = weight;
  }
  joinSpans(before.seen, result.map, result.seen);
  result.earlier->common = both.seen_again;
  result.earlier->appeared = both.appeared;
  result.earlier->vanished = both.vanished;
  result.earlier->unseen = both.unseen;
  result.map.provenance.history = before.provenance.history;
}

}  // namespace roomgraph
