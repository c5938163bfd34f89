// SPDX-License-Identifier: BSD-3-Clause
// Commands that read the catalogue of a batch.
#pragma once

#include <CLI/CLI.hpp>

namespace roomgraph {

/// status, compare, query, export, report and import below `batch`.
void addBatchTables(CLI::App& batch);

}  // namespace roomgraph
