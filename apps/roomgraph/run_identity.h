// SPDX-License-Identifier: BSD-3-Clause
// What a run depends on: by this it is known whether a checkpoint is one of it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roomgraph/pipeline/setup.h"
#include "run_options.h"

namespace roomgraph {

/// Everything on which the results of a run depend, name by name: the recording (size, time, bytes here and
/// there), the effective configuration key by key, objects, networks and other files (SHA-256), program and
/// libraries (SHA-256), span, earlier map (SHA-256), and which further files it writes.
using RunIdentity = std::vector<std::pair<std::string, std::string>>;

/// Throws InputError: a file cannot be read.
RunIdentity identityOf(const RunOptions& options, const Setup& setup);

/// One sentence about the first difference; empty: they are the same.
std::string differenceOf(const RunIdentity& before, const RunIdentity& now);

}  // namespace roomgraph
