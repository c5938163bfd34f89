// SPDX-License-Identifier: BSD-3-Clause
// Version, source revision and command line of the running program.
#pragma once

#include <string>
#include <vector>

namespace roomgraph {

/// Of the program: the release, and the commit that it was built from ("unknown" outside a git checkout;
/// "-dirty" when files were changed).
extern const char* const kVersion;
extern const char* const kRevision;

/// The words of the command line, the program's name first.
std::vector<std::string> commandLine();

}  // namespace roomgraph
