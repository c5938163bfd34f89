// SPDX-License-Identifier: BSD-3-Clause
// List of the detector classes, registered when the library is loaded.
#include "roomgraph/detection/register_classes.h"

#include <mrpt/core/initializer.h>

#include "auto_detector.h"

namespace roomgraph::detection {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Stage));
  mrpt::rtti::registerClass(CLASS_ID(Detector));
  mrpt::rtti::registerClass(CLASS_ID(AutoDetector));
  mrpt::rtti::registerClass(CLASS_ID(DnnDetector));
  mrpt::rtti::registerClass(CLASS_ID(RecordedDetector));
}

}  // namespace roomgraph::detection

MRPT_INITIALIZER(registerRoomgraphDetection) {
  roomgraph::detection::registerClasses();
}
