// SPDX-License-Identifier: BSD-3-Clause
// List of the lidar classes, registered when the library is loaded.
#include "roomgraph/lidar/register_classes.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>

#include "submap_loop_closer.h"
#include "submap_scan_matcher.h"

namespace roomgraph::lidar {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(ScanMatcher));
  mrpt::rtti::registerClass(CLASS_ID(ScanLoopCloser));
  mrpt::rtti::registerClass(CLASS_ID(SubmapScanMatcher));
  mrpt::rtti::registerClass(CLASS_ID(SubmapLoopCloser));
}

}  // namespace roomgraph::lidar

MRPT_INITIALIZER(registerRoomgraphLidar) {
  roomgraph::lidar::registerClasses();
}
