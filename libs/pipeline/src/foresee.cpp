// SPDX-License-Identifier: BSD-3-Clause
// What is computed of a frame before its turn, beside the run.
#include "detection_schedule.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

void SemanticSlam::foresee(const Record& record) {
  const Frame* frame = std::get_if<Frame>(&record);
  if (!frame || frame->t <= last_foreseen_t_) return;
  last_foreseen_t_ = frame->t;
  const Stages& stages = setup_->stages;
  if (stages.detector && foreseen_detections_->due(frame->t) && stages.detector->foresee(*frame))
    foreseen_detections_->ran(frame->t);
  else
    foreseen_detections_->missed();
  if (stages.rgbd_odometry) stages.rgbd_odometry->foresee(*frame);
}

}  // namespace roomgraph
