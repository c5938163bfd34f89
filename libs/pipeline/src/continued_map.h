// SPDX-License-Identifier: BSD-3-Clause
// The map of a run as the continuation of an earlier one.
#pragma once

#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// What of the run, other than its result, the continuation needs.
struct RunForContinuation {
  const ObjectMapper& objects;
  const ObjectDatabase& database;
  const Options& options;
};

/// What re-localisation in this map has to do without, in words; empty: nothing.
std::string missingIn(const CSemanticMap& map);

/// Whether the run is in the earlier map's frame, when it knew, and by what.
EarlierMap earlierMapOf(const MapAnchor& anchor, double first_t);

/// Landmarks, spans and history of the result's map, which is in the earlier one's frame, become those of
/// both. Grid and views are not touched.
void continueMap(const MapAnchor& anchor, const RunForContinuation& run, SlamResult& result);

}  // namespace roomgraph
