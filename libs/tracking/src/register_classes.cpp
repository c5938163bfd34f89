// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/tracking/register_classes.h"

#include <mrpt/core/initializer.h>

#include "roomgraph/tracking/feature_odometry.h"

namespace roomgraph::tracking {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Stage));
  mrpt::rtti::registerClass(CLASS_ID(RgbdOdometry));
  mrpt::rtti::registerClass(CLASS_ID(FeatureOdometry));
}

}  // namespace roomgraph::tracking

MRPT_INITIALIZER(registerRoomgraphTracking) {
  roomgraph::tracking::registerClasses();
}
