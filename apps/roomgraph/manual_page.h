// SPDX-License-Identifier: BSD-3-Clause
// The manual page roomgraph(1), made of the declared command line.
#pragma once

#include <string>

#include "command_tree.h"

namespace roomgraph {

/// roff text with man macros: all sub-commands with their arguments, options and examples.
std::string manualPage(const CommandEntry& root, const std::string& version);

}  // namespace roomgraph
