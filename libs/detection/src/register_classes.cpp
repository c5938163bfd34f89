// SPDX-License-Identifier: BSD-3-Clause
// List of the detectors and network decoders, registered when the library is loaded.
#include "roomgraph/detection/register_classes.h"

#include <mrpt/core/initializer.h>

#include "ade20k_decoder.h"
#include "auto_detector.h"
#include "darknet_decoder.h"
#include "nanodet_decoder.h"
#include "room_decoder.h"
#include "yolox_decoder.h"

namespace roomgraph::detection {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Stage));
  mrpt::rtti::registerClass(CLASS_ID(Detector));
  mrpt::rtti::registerClass(CLASS_ID(AutoDetector));
  mrpt::rtti::registerClass(CLASS_ID(DnnDetector));
  mrpt::rtti::registerClass(CLASS_ID(RecordedDetector));
  mrpt::rtti::registerClass(CLASS_ID(NetworkDecoder));
  mrpt::rtti::registerClass(CLASS_ID(Ade20kDecoder));
  mrpt::rtti::registerClass(CLASS_ID(DarknetDecoder));
  mrpt::rtti::registerClass(CLASS_ID(NanodetDecoder));
  mrpt::rtti::registerClass(CLASS_ID(RoomDecoder));
  mrpt::rtti::registerClass(CLASS_ID(YoloxDecoder));
}

}  // namespace roomgraph::detection

MRPT_INITIALIZER(registerRoomgraphDetection) {
  roomgraph::detection::registerClasses();
}
