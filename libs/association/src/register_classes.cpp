// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/association/register_classes.h"

#include "roomgraph/association/maximum_likelihood_associator.h"
#include "roomgraph/association/nearest_neighbor_associator.h"
#include "roomgraph/association/soft_associator.h"

namespace roomgraph::association {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(Associator));
  mrpt::rtti::registerClass(CLASS_ID(MaximumLikelihoodAssociator));
  mrpt::rtti::registerClass(CLASS_ID(NearestNeighborAssociator));
  mrpt::rtti::registerClass(CLASS_ID(SoftAssociator));
}

}  // namespace roomgraph::association
