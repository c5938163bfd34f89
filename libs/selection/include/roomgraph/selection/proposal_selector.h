// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// Chooses among the proposals of each detection (method.md sec. 3).
class ProposalSelector : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ProposalSelector)
 public:
  /// At most one measurement per detection.
  virtual std::vector<ObjectMeasurement> select(const FrameProposals& frame) = 0;
};

}  // namespace roomgraph
