// SPDX-License-Identifier: BSD-3-Clause
// Sightings of every landmark, summed up from the associations of a run.
#pragma once

#include <istream>
#include <map>

#include "run_data.h"

namespace roomgraph {

/// By landmark, of the lines of associations.jsonl. Throws InputError naming `name` and line.
std::map<int, SightingSummary> readSightings(std::istream& lines, const std::string& name, double start_t,
                                             double duration_s);

}  // namespace roomgraph
