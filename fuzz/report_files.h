// SPDX-License-Identifier: BSD-3-Clause
// Files of a run that a report is made of, in the order of the parts of an input.
#pragma once

namespace roomgraph::fuzz {

inline constexpr const char* kFilesOfReport[] = {
    "summary.json",       "trajectory.tum", "live.tum",   "landmarks.json", "candidates.json",
    "associations.jsonl", "timings.csv",    "lost.jsonl", "views.jsonl",    "config.ini",
    "objects.ini",        "map.yaml",       "graph.g2o",  "map.pgm"};

}  // namespace roomgraph::fuzz
