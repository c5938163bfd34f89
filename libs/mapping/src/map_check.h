// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <string>

#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph {

/// Why a map read from a file cannot be used ("landmark 3: position is not finite"); empty when it can.
std::string problemOf(const CSemanticMap& map);

}  // namespace roomgraph
