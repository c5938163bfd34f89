// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/backend/register_classes.h"

namespace roomgraph::backend {
void registerClasses() {}
}  // namespace roomgraph::backend
