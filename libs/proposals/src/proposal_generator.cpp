// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the ProposalGenerator interface.
#include "roomgraph/proposals/proposal_generator.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ProposalGenerator, Stage, roomgraph)
}  // namespace roomgraph
