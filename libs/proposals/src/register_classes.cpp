// SPDX-License-Identifier: BSD-3-Clause
// List of the classes made by name: ground detectors, proposal and shape generators.
#include "roomgraph/proposals/register_classes.h"

#include <mrpt/core/initializer.h>

#include "cuboid_generator.h"
#include "cylinder_generator.h"
#include "depth_ground_detector.h"
#include "door_generator.h"
#include "geometric_proposal_generator.h"

namespace roomgraph::proposals {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Stage));
  mrpt::rtti::registerClass(CLASS_ID(GroundDetector));
  mrpt::rtti::registerClass(CLASS_ID(DepthGroundDetector));
  mrpt::rtti::registerClass(CLASS_ID(ExpectedGroundDetector));
  mrpt::rtti::registerClass(CLASS_ID(ProposalGenerator));
  mrpt::rtti::registerClass(CLASS_ID(GeometricProposalGenerator));
  mrpt::rtti::registerClass(CLASS_ID(ShapeGenerator));
  mrpt::rtti::registerClass(CLASS_ID(CylinderGenerator));
  mrpt::rtti::registerClass(CLASS_ID(CuboidGenerator));
  mrpt::rtti::registerClass(CLASS_ID(DoorGenerator));
}

}  // namespace roomgraph::proposals

MRPT_INITIALIZER(registerRoomgraphProposals) {
  roomgraph::proposals::registerClasses();
}
