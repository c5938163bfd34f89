// SPDX-License-Identifier: BSD-3-Clause
// Ages of detections, and carrying of boxes until they are too old or cannot be tracked.
#include "detection_schedule.h"

namespace roomgraph {

bool DetectionClock::due(double t) const {
  constexpr double kJitter_s = 0.002;  // of stamps: a camera at the wanted rate is not halved by it
  if (!age_) return true;
  return *age_ + 1 >= every_nth_frame_ && (rate_hz_ == 0 || t > period_end_s_ - kJitter_s);
}

void DetectionClock::ran(double t) {
  age_ = 0;
  if (rate_hz_ == 0) return;
  // From the end of the last period, so that the mean rate is the wanted one; anew after a pause.
  const double period = 1 / rate_hz_;
  period_end_s_ = (t - period_end_s_ < period ? period_end_s_ : t) + period;
}

FrameDetections DetectionSchedule::detected(std::vector<Detection> boxes, const Frame& frame) {
  clock_.ran(frame.t);
  carried_from_.reset();
  if (options_.track_boxes && options_.max_carried_frames > 0) {
    tracker_.start(boxes, frame);
    carried_from_ = frame.t;
  }
  return {.boxes = std::move(boxes), .fresh = true};
}

FrameDetections DetectionSchedule::missed(const Frame& frame, const std::optional<Pose3>& previous_from_current) {
  if (!clock_.age()) return {};
  clock_.missed();
  FrameDetections out{.age = *clock_.age()};
  if (!carried_from_) return out;
  carried_from_.reset();
  if (out.age > options_.max_carried_frames) return out;
  auto carried = tracker_.advance(frame, previous_from_current);
  if (!carried) return out;
  carried_from_ = frame.t;
  out.carried = true;
  out.boxes = std::move(*carried);
  return out;
}

}  // namespace roomgraph
