// SPDX-License-Identifier: BSD-3-Clause
// What the sub-commands of `roomgraph map` share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Name, version and revision, as maps keep it.
std::string programName();

/// The object database that was asked for; else the map's own; else the one beside the file or the shipped
/// one.
ObjectDatabase databaseOf(const CSemanticMap& map, const std::string& file, const std::string& asked_for);

/// Add `map diff`, `map join` and `map merge`.
void addMapDiff(CLI::App& parent);
void addMapJoin(CLI::App& parent);
void addMapMerge(CLI::App& parent);

}  // namespace roomgraph
