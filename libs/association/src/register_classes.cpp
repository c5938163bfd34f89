// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/association/register_classes.h"

#include "roomgraph/association/gated_associator.h"

namespace roomgraph::association {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Associator));
  mrpt::rtti::registerClass(CLASS_ID(GatedAssociator));
}

}  // namespace roomgraph::association
