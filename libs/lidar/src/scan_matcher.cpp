// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the scan matching interfaces.
#include "roomgraph/lidar/scan_matcher.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ScanMatcher, Stage, roomgraph)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ScanLoopCloser, Stage, roomgraph)
}  // namespace roomgraph
