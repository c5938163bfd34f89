// SPDX-License-Identifier: BSD-3-Clause
// List of the selector classes registered with MRPT.
#include "roomgraph/selection/register_classes.h"

#include "best_score_selector.h"
#include "crf_selector.h"
#include "unary_selector.h"

namespace roomgraph::selection {

void registerClasses() {
  mrpt::rtti::registerClass(CLASS_ID(ProposalSelector));
  mrpt::rtti::registerClass(CLASS_ID(BestScoreSelector));
  mrpt::rtti::registerClass(CLASS_ID(CrfSelector));
  mrpt::rtti::registerClass(CLASS_ID(UnarySelector));
}

}  // namespace roomgraph::selection
