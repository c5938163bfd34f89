// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/detection/detector.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Detector, Stage, roomgraph)
}  // namespace roomgraph
