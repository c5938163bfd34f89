// SPDX-License-Identifier: BSD-3-Clause
// Report of one processed record, and the interface of its observers (Sink).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/estimation/object_decision.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/proposal.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// The detections that stand for one frame.
struct FrameDetections {
  std::vector<Detection> boxes;
  bool fresh = false;    ///< the detector ran on this frame
  bool carried = false;  ///< it did not: the boxes were tracked from the frames before
  int age = 0;           ///< frames since the detector ran; 0: on this one, or never
  std::vector<std::string> unsought{};  ///< classes that it did not look for when it ran on this frame

  /// Whether anything is known of the objects in this frame (even that there are none).
  bool current() const { return fresh || carried; }
};

/// What one record changed; published to sinks after every step.
struct StepReport {
  enum class Kind { kFrame, kScan, kOther };
  Kind kind = Kind::kOther;
  double t = 0;
  Pose3 world_from_robot = Pose3::Identity();  ///< as known now, without hindsight
  std::string note;                            ///< "lost: too few inliers", …; empty when all is well
  // Frames only:
  FrameId frame;
  FrameDetections detections;
  std::optional<FrameProposals> proposals;
  std::vector<ObjectDecision> decisions;
  const Frame* image = nullptr;  ///< valid during Sink::onStep()
  // Scans only:
  std::optional<Scan> scan;  ///< what of it went into the grid: returns on what moves are left out
};

/// Whoever watches a run. The pipeline never knows who.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void onStep(const StepReport& report) = 0;
};

}  // namespace roomgraph
