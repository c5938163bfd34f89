// SPDX-License-Identifier: BSD-3-Clause
// Ages of detections, and carrying of boxes until they are too old or cannot be tracked.
#include "detection_schedule.h"

#include <algorithm>

namespace roomgraph {

bool DetectionClock::due(double t) const {
  return !age_ || (*age_ + 1 >= every_nth_frame_ && rate_.due(t));
}

void DetectionClock::ran(double t) {
  age_ = 0;
  rate_.ran(t);
}

// Boxes of classes that were looked for too long ago are left out.
std::optional<std::vector<Detection>> DetectionSchedule::carriedTo(
    const Frame& frame, const std::optional<Pose3>& previous_from_current) {
  auto boxes = tracker_.advance(frame, previous_from_current);
  if (boxes)
    std::erase_if(*boxes, [this](const Detection& box) {
      const auto since = unsought_for_.find(box.class_name);
      return since != unsought_for_.end() && since->second > options_.max_carried_frames;
    });
  return boxes;
}

// `age`: of the last detections in this frame.
void DetectionSchedule::count(const std::vector<std::string>& unsought, int age) {
  std::map<std::string, int> counted;
  for (const auto& name : unsought) {
    const auto before = unsought_for_.find(name);
    counted[name] = before == unsought_for_.end() ? age : before->second + 1;
  }
  unsought_for_ = std::move(counted);
}

FrameDetections DetectionSchedule::detected(std::vector<Detection> boxes, const Frame& frame,
                                            const std::vector<std::string>& unsought,
                                            const std::optional<Pose3>& previous_from_current) {
  count(unsought, clock_.age().value_or(0) + 1);
  clock_.ran(frame.t);
  if (carried_from_ && !unsought.empty())
    for (auto& box : carriedTo(frame, previous_from_current).value_or(std::vector<Detection>{}))
      if (unsought_for_.contains(box.class_name)) boxes.push_back(std::move(box));
  std::stable_sort(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  carried_from_.reset();
  if (options_.track_boxes && options_.max_carried_frames > 0) {
    tracker_.start(boxes, frame);
    carried_from_ = frame.t;
  }
  return {.boxes = std::move(boxes), .fresh = true, .unsought = unsought};
}

FrameDetections DetectionSchedule::missed(const Frame& frame, const std::optional<Pose3>& previous_from_current) {
  if (!clock_.age()) return {};
  clock_.missed();
  for (auto& [name, frames] : unsought_for_) ++frames;
  FrameDetections out{.age = *clock_.age()};
  if (!carried_from_) return out;
  carried_from_.reset();
  if (out.age > options_.max_carried_frames) return out;
  auto carried = carriedTo(frame, previous_from_current);
  if (!carried) return out;
  carried_from_ = frame.t;
  out.carried = true;
  out.boxes = std::move(*carried);
  return out;
}

}  // namespace roomgraph
