// SPDX-License-Identifier: BSD-3-Clause
// Insertion of one step's detections into the rawlog copy.
#include "roomgraph/pipeline/detection_recording.h"

#include "roomgraph/detection/detection_record.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {

void DetectionRecording::onStep(const StepReport& report) {
  if (!report.image || !report.detections.fresh) return;
  Frame recorded = *report.image;
  if (const auto offset = time_offsets_s_.find(recorded.sensor_label); offset != time_offsets_s_.end()) recorded.t -= offset->second;
  copy_.insert(toRecord(recorded, report.detections.boxes, detector_.identity(), report.detections.unsought));
}

void DetectionFile::onStep(const StepReport& report) {
  if (report.image && report.detections.fresh)
    writer_.write(toComment(toRecord(*report.image, report.detections.boxes, detector_.identity(), report.detections.unsought)));
}

}  // namespace roomgraph
