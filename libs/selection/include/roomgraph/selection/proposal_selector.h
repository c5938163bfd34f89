// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/geometry/camera.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// One frame for the selector, with what links it to the frame before.
struct SelectionInput {
  const FrameProposals& frame;
  PinholeCamera camera;
  std::optional<Pose3>
      previous_from_current;  ///< movement of the camera since the last frame given; nothing if unknown
};

/// Chooses among the proposals of each detection (method.md sec. 3).
class ProposalSelector : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ProposalSelector)
 public:
  /// At most one measurement per detection.
  virtual std::vector<ObjectMeasurement> select(const SelectionInput& input) = 0;
};

}  // namespace roomgraph
