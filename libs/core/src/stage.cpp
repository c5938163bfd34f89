// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/core/stage.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Stage, mrpt::rtti::CObject, roomgraph)
}  // namespace roomgraph
