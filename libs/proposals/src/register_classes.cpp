// SPDX-License-Identifier: BSD-3-Clause
// List of the proposal generator classes, registered when the library is loaded.
#include "roomgraph/proposals/register_classes.h"

#include <mrpt/core/initializer.h>

#include "geometric_proposal_generator.h"

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
