// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ProposalSelector, Stage, roomgraph)
}  // namespace roomgraph
