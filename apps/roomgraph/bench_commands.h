// SPDX-License-Identifier: BSD-3-Clause
// Subcommands of `roomgraph bench`.
#pragma once

#include <CLI/CLI.hpp>

namespace roomgraph {

void addSpeedCommand(CLI::App& bench);

}  // namespace roomgraph
