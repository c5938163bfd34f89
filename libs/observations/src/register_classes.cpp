// SPDX-License-Identifier: BSD-3-Clause
// List of the serialisable classes, registered when the library is loaded.
#include "roomgraph/observations/register_classes.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>

#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/CSemanticMap.h"

namespace roomgraph::observations {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(CObservationDetections));
  mrpt::rtti::registerClass(CLASS_ID(CSemanticMap));
}

}  // namespace roomgraph::observations

MRPT_INITIALIZER(registerRoomgraphObservations) {
  roomgraph::observations::registerClasses();
}
