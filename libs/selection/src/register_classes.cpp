// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/selection/register_classes.h"

#include "roomgraph/selection/best_score_selector.h"
#include "roomgraph/selection/crf_selector.h"
#include "roomgraph/selection/unary_selector.h"

namespace roomgraph::selection {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(ProposalSelector));
  mrpt::rtti::registerClass(CLASS_ID(BestScoreSelector));
  mrpt::rtti::registerClass(CLASS_ID(CrfSelector));
  mrpt::rtti::registerClass(CLASS_ID(UnarySelector));
}

}  // namespace roomgraph::selection
