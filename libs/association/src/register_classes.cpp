// SPDX-License-Identifier: BSD-3-Clause
// List of the associator classes registered with MRPT.
#include "roomgraph/association/register_classes.h"

#include "maximum_likelihood_associator.h"
#include "nearest_neighbor_associator.h"
#include "soft_associator.h"

namespace roomgraph::association {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Associator));
  mrpt::rtti::registerClass(CLASS_ID(MaximumLikelihoodAssociator));
  mrpt::rtti::registerClass(CLASS_ID(NearestNeighborAssociator));
  mrpt::rtti::registerClass(CLASS_ID(SoftAssociator));
}

}  // namespace roomgraph::association
