// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the Associator interface.
#include "roomgraph/association/associator.h"

namespace roomgraph {
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Associator, Stage, roomgraph)
}  // namespace roomgraph
