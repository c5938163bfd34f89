// SPDX-License-Identifier: BSD-3-Clause
// Proposal generator from box, ground and depth by the shape generators of the classes.
#pragma once

#include "roomgraph/proposals/proposal_generator.h"

namespace roomgraph {

/// Box + ground + depth -> placed shapes, by the shape generator of the detection's class. Covariances are of (x, y,
/// z, yaw) in the ground frame (geometry/ground.h: below the camera, x along the optical axis' horizontal direction, y
/// left, z up). Its score is the detection's initialisation score times the shape's quality. The
/// proposals of a detection are consecutive, best first.
class GeometricProposalGenerator : public ProposalGenerator {
  DEFINE_MRPT_OBJECT(GeometricProposalGenerator, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  void setDatabase(const ObjectDatabase& database) override { database_ = &database; }
  void setShapeGenerators(ShapeGenerators generators) override { generators_ = std::move(generators); }
  /// Makes the shape generators, with default parameters, when none were set.
  void prepare() override;
  FrameProposals generate(const Frame& frame, const std::vector<Detection>& detections,
                          const FrameGround& ground) override;
  void keepTraces(bool keep) override { keep_traces_ = keep; }

 private:
  void propose(const Frame& frame, int index, FrameProposals& out) const;

  GeneratorLimits limits_;
  ShapeGenerators generators_;
  bool use_depth_ = true, keep_traces_ = false;
  const ObjectDatabase* database_ = nullptr;
};

}  // namespace roomgraph
