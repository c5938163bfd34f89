// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the Stage base class.
#include "roomgraph/core/stage.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Stage, mrpt::rtti::CObject, roomgraph)
}  // namespace roomgraph
