// SPDX-License-Identifier: BSD-3-Clause
// Insertion of one step's detections into the rawlog copy.
#include "roomgraph/pipeline/detection_recording.h"

#include "roomgraph/detection/detection_record.h"
#include "roomgraph/observations/detection_comment.h"

namespace roomgraph {

void DetectionRecording::onStep(const StepReport& report) {
  if (report.image && report.detections.fresh)
    copy_.insert(toRecord(*report.image, report.detections.boxes, detector_.identity(), report.detections.unsought));
}

void DetectionFile::onStep(const StepReport& report) {
  if (report.image && report.detections.fresh)
    writer_.write(toComment(toRecord(*report.image, report.detections.boxes, detector_.identity(), report.detections.unsought)));
}

}  // namespace roomgraph
