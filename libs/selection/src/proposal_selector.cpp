// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the ProposalSelector interface.
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ProposalSelector, Stage, roomgraph)
}  // namespace roomgraph
