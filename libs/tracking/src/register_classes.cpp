// SPDX-License-Identifier: BSD-3-Clause
// List of the visual odometry classes, registered when the library is loaded.
#include "roomgraph/tracking/register_classes.h"

#include <mrpt/core/initializer.h>

#include "feature_odometry.h"

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
