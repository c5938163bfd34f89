// SPDX-License-Identifier: BSD-3-Clause
// Completion of roomgraph's command line in shells: static scripts, which never start the program.
#pragma once

#include <string>

#include "command_tree.h"

namespace roomgraph {

/// To be sourced, or put where the shell looks for them: share/bash-completion/completions/roomgraph,
/// share/zsh/site-functions/_roomgraph, share/fish/vendor_completions.d/roomgraph.fish.
std::string bashCompletion(const CommandEntry& root);
std::string zshCompletion(const CommandEntry& root);
std::string fishCompletion(const CommandEntry& root);

}  // namespace roomgraph
