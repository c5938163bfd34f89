// SPDX-License-Identifier: BSD-3-Clause
// Report of one processed record, and the interface of its observers (Sink).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/proposal.h"

namespace roomgraph {

/// One selected measurement and what became of it.
struct ObjectDecision {
  WorldMeasurement seen;
  Association association;
  LandmarkId landmark;  ///< the landmark it was fused into (a new one's id when it was made)
};

/// What one record changed; published to sinks after every step.
struct StepReport {
  enum class Kind { kFrame, kScan, kOther };
  Kind kind = Kind::kOther;
  double t = 0;
  FrameId frame;                               ///< frames only
  Pose3 world_from_robot = Pose3::Identity();  ///< as known now, without hindsight
  bool detector_ran = false;
  bool boxes_carried = false;         ///< it did not: `detections` were tracked from the frames before
  std::vector<Detection> detections;  ///< what the detector found, or what was carried
  std::vector<ObjectDecision> decisions;
  std::string note;                      ///< "lost: too few inliers", …; empty when all is well
  const Frame* image = nullptr;          ///< frames only; valid during Sink::onStep()
  const FrameProposals* seen = nullptr;  ///< frames only; valid during Sink::onStep()
};

/// Whoever watches a run. The pipeline never knows who.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void onStep(const StepReport& report) = 0;
};

}  // namespace roomgraph
