// SPDX-License-Identifier: BSD-3-Clause
// DetectionSchedule: when the detector runs, and how long its boxes are carried over the frames after it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/core/rate_clock.h"
#include "roomgraph/detection/box_tracker.h"
#include "roomgraph/pipeline/options.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// Tells on which frames the detector is to run: `every_nth_frame` frames after the last one on which it ran, and when a period
/// of `rate_hz` is over. Of every frame either ran() or missed() is told, in order of time.
class DetectionClock {
 public:
  explicit DetectionClock(const DetectionStageOptions& options)
      : every_nth_frame_(options.every_nth_frame), rate_(options.rate_hz) {}

  /// Whether the detector is to run on the frame of time `t`, s. One that fails is asked again on the next frame.
  bool due(double t) const;
  void ran(double t);
  void missed() {
    if (age_) ++*age_;
  }
  /// Frames since the detector ran; nothing: it never ran.
  std::optional<int> age() const { return age_; }

 private:
  int every_nth_frame_;
  RateClock rate_;
  std::optional<int> age_;
};

/// Decides on which frames the detector runs (`every_nth_frame`, `rate_hz`) and carries its boxes over the frames after it
/// (`track_boxes`, `max_carried_frames`). Of every frame either detected() or missed() is told, in order of time.
class DetectionSchedule {
 public:
  /// The database outlives the schedule; it says which classes move by themselves.
  DetectionSchedule(const DetectionStageOptions& options, const ObjectDatabase& database)
      : options_(options), clock_(options), tracker_(database) {}

  bool due(double t) const { return clock_.due(t); }

  /// The detector ran on this frame; its boxes replace all carried ones, but for those of the classes in `unsought`, for which
  /// it did not look. `previous_from_current`: as for missed().
  FrameDetections detected(std::vector<Detection> boxes, const Frame& frame, const std::vector<std::string>& unsought = {},
                           const std::optional<Pose3>& previous_from_current = {});
  /// It did not run, or failed. `previous_from_current`: movement of the camera since the frame at carriedFrom(),
  /// optical frames; nothing when it is not known.
  FrameDetections missed(const Frame& frame, const std::optional<Pose3>& previous_from_current);

  /// Time of the last frame, s, when it has boxes that can be carried on.
  std::optional<double> carriedFrom() const { return carried_from_; }

 private:
  std::optional<std::vector<Detection>> carriedTo(const Frame& frame,
                                                  const std::optional<Pose3>& previous_from_current);
  void count(const std::vector<std::string>& unsought, int age);

  DetectionStageOptions options_;
  DetectionClock clock_;
  BoxTracker tracker_;
  std::optional<double> carried_from_;
  std::map<std::string, int> unsought_for_;  ///< frames since the detector looked for a class, where it last did not
};

}  // namespace roomgraph
