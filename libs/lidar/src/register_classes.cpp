// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/lidar/register_classes.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>

#include "roomgraph/lidar/submap_loop_closer.h"
#include "roomgraph/lidar/submap_scan_matcher.h"

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
