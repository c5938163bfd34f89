// SPDX-License-Identifier: BSD-3-Clause
// Interface of proposal generation: 3D hypotheses from detections, depth and ground.
#pragma once

#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"
#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph {

/// Detections + depth + ground -> 3D proposals (method.md sec. 1.3 to 1.D).
class ProposalGenerator : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ProposalGenerator)
 public:
  /// The object database outlives the generator; called before prepare().
  virtual void setDatabase(const ObjectDatabase& database) = 0;
  /// The shape generators that the database's classes name; called before prepare(). A proposal generator that does not
  /// use any ignores them.
  virtual void setShapeGenerators(ShapeGenerators generators) { (void)generators; }  // NOLINT: others keep it
  /// Proposals of every detection; none without a ground plane. The ground becomes part of the result.
  virtual FrameProposals generate(const Frame& frame, const std::vector<Detection>& detections,
                                  const FrameGround& ground) = 0;
  /// Whether generate() fills in FrameProposals::traces.
  virtual void keepTraces(bool keep) { (void)keep; }
};

}  // namespace roomgraph
