// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/proposals/register_classes.h"

#include <mrpt/core/initializer.h>

#include "roomgraph/proposals/geometric_proposal_generator.h"

namespace roomgraph::proposals {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Stage));
  mrpt::rtti::registerClass(CLASS_ID(ProposalGenerator));
  mrpt::rtti::registerClass(CLASS_ID(GeometricProposalGenerator));
}

}  // namespace roomgraph::proposals

MRPT_INITIALIZER(registerRoomgraphProposals) {
  roomgraph::proposals::registerClasses();
}
