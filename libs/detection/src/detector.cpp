// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the Detector interface.
#include "roomgraph/detection/detector.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Detector, Stage, roomgraph)
}  // namespace roomgraph
