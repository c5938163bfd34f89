// SPDX-License-Identifier: BSD-3-Clause
// Counts, warnings, timings and memory from the summary of a run, and work per record.
#pragma once

#include <filesystem>
#include <istream>

#include "run_data.h"

namespace roomgraph {

/// Fills what summary.json says. Throws InputError.
void readSummary(const std::filesystem::path& file, RunData& run);

/// Adds the processor time of every stage, and the work on each record over time, from timings.csv.
/// Throws InputError naming `name` and line.
void readTimings(std::istream& lines, const std::string& name, RunData& run);

}  // namespace roomgraph
