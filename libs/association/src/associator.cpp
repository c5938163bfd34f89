// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/association/associator.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Associator, Stage, roomgraph)
}  // namespace roomgraph
