// SPDX-License-Identifier: BSD-3-Clause
// Debug pictures: detections, depth samples, hypotheses and landmarks drawn into the image.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "roomgraph/observations/object_database.h"
#include "roomgraph/pipeline/step_report.h"

namespace roomgraph {

/// What the program made of one frame, drawn into its colour image (CV_8UC3, BGR): the ground's grid and
/// horizon, boxes with class and score (dashed when carried), the depth samples taken for each object, the
/// edges used, rejected hypotheses thin, chosen shapes with landmark and score, and in a line of text what
/// went wrong. Empty when the report is not of a frame with an image.
cv::Mat debugPicture(const StepReport& report, const ObjectDatabase& database);

/// Writes DIR/frame_000123.jpg for every frame of a run; the number is that of the frame.
class DebugPictures : public Sink {
 public:
  /// Makes the folder. Throws RunError when it cannot be made. The database outlives the sink.
  DebugPictures(const std::filesystem::path& folder, const ObjectDatabase& database);
  /// Throws RunError when a picture cannot be written.
  void onStep(const StepReport& report) override;

 private:
  std::filesystem::path folder_;
  const ObjectDatabase& database_;
};

}  // namespace roomgraph
