// SPDX-License-Identifier: BSD-3-Clause
// Data of the page as one JSON text that may stand inside an HTML script element.
#pragma once

#include "run_data.h"

namespace roomgraph {

/// Numbers are rounded to what can be seen; names that are no UTF-8 are repaired. Neither "</" nor "<!--"
/// occurs.
std::string dataJson(const std::vector<RunData>& runs);

}  // namespace roomgraph
