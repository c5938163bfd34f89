// SPDX-License-Identifier: BSD-3-Clause
// What is computed of a record before its turn, beside the run.
#include "detection_schedule.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

void SemanticSlam::foresee(const Record& record) {
  if (const Frame* frame = std::get_if<Frame>(&record)) {
    if (frame->t <= last_foreseen_t_) return;
    last_foreseen_t_ = frame->t;
    foreseeDetections(*frame);
  }
  front_ends_.foresee(record);
}

void SemanticSlam::foreseeDetections(const Frame& frame) {
  const auto& detector = setup_->stages.detector;
  if (detector && foreseen_detections_->due(frame.t) && detector->due(frame) && detector->foresee(frame))
    foreseen_detections_->ran(frame.t);
  else
    foreseen_detections_->missed();
}

}  // namespace roomgraph
