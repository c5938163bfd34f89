// SPDX-License-Identifier: BSD-3-Clause
// Ground detectors that ship: search in the depth image, and none.
#pragma once

#include "ground_plane.h"
#include "roomgraph/proposals/ground_detector.h"

namespace roomgraph {

/// Searches the floor among the planes of the depth image (findGround).
class DepthGroundDetector : public GroundDetector {
  DEFINE_MRPT_OBJECT(DepthGroundDetector, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  Outcome<GroundEstimate> detect(const Frame& frame, const std::optional<Plane>& expected) override;

 private:
  GroundSearch search_;
};

/// Without depth: the expected plane is used unchanged.
class ExpectedGroundDetector : public GroundDetector {
  DEFINE_MRPT_OBJECT(ExpectedGroundDetector, roomgraph)
 public:
  Outcome<GroundEstimate> detect(const Frame& frame, const std::optional<Plane>& expected) override;
};

}  // namespace roomgraph
