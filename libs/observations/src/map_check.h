// SPDX-License-Identifier: BSD-3-Clause
// Consistency check of a map read from a file.
#pragma once

#include <string>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Why a map read from a file cannot be used ("landmark 3: position is not finite"); empty when it can.
std::string problemOf(const CSemanticMap& map);

}  // namespace roomgraph
