// SPDX-License-Identifier: BSD-3-Clause
// Interface of proposal generation: 3D hypotheses from detections, depth and ground.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/observations/proposal.h"
#include "roomgraph/proposals/shape_generator.h"

namespace roomgraph {

/// Detections + depth + ground -> 3D proposals (method.md sec. 1.2 to 1.D).
class ProposalGenerator : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ProposalGenerator)
 public:
  /// The object database outlives the generator; called before prepare().
  virtual void setDatabase(const ObjectDatabase& database) = 0;
  /// The shape generators that the database's classes name; called before prepare(). One that makes its shapes in
  /// another way ignores them.
  virtual void setShapeGenerators(ShapeGenerators generators) { (void)generators; }
  /// `expected_ground`: plane predicted from extrinsics or from the frames before, camera frame; nothing when
  /// unknown (a handheld camera that has not seen the floor yet).
  virtual FrameProposals generate(const Frame& frame, const std::vector<Detection>& detections,
                                  const std::optional<Plane>& expected_ground) = 0;
  /// Whether generate() fills in FrameProposals::traces.
  virtual void keepTraces(bool keep) { (void)keep; }
};

}  // namespace roomgraph
