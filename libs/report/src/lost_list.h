// SPDX-License-Identifier: BSD-3-Clause
// Spans of a run without help from a sensor, from lost.jsonl.
#pragma once

#include <istream>
#include <vector>

#include "run_data.h"

namespace roomgraph {

/// Times count from `start_t`. Throws InputError naming file and line.
std::vector<LostRow> readLost(std::istream& lines, double start_t);

}  // namespace roomgraph
