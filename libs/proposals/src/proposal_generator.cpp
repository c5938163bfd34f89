// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/proposals/proposal_generator.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ProposalGenerator, Stage, roomgraph)
}  // namespace roomgraph
