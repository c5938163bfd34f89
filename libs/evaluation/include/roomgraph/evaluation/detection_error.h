// SPDX-License-Identifier: BSD-3-Clause
// Precision, recall and average precision of detections against true boxes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "roomgraph/evaluation/forgiven_kinds.h"
#include "roomgraph/evaluation/frame_files.h"

namespace roomgraph {

struct DetectionOptions {
  double min_iou = 0.5;            ///< of a detection and the true box it finds
  double min_score = 0;            ///< weaker detections are left out
  double min_visible = 0.5;        ///< true boxes that count show more of the object …
  double min_height_px = 40;       ///< … and are higher
  double max_difference_s = 0.02;  ///< largest difference of the stamps of a frame
  ForgivenKinds forgiven_kinds = forgivenChairs();
};

struct DetectionFigures {
  int correct = 0, false_alarms = 0, missed = 0;
  int ignored = 0;                           ///< detections that count neither way
  double precision = 0, recall = 0, f1 = 0;  ///< 0 where the denominator is 0
  double ap = 0;  ///< average precision: area under the precision envelope over recall, at every score
};

struct DetectionErrors {
  std::map<std::string, DetectionFigures> per_class;
  DetectionFigures
      all;  ///< counts of all classes together; its ap is the mean of the classes with true boxes
  double mean_precision = 0, mean_recall = 0;  ///< over classes with detections, and with true boxes
  int frames = 0;                              ///< compared
  int frames_without_truth = 0;
  int frames_without_detector = 0;  ///< true frames on which the detector did not run; left out
};

/// Compares detected with true boxes, class by class. Within a frame each detection, by descending score,
/// is matched with the free true box of its class of the highest IoU, as the COCO evaluation does. True
/// boxes that show too little of the object, and forgiven kinds, are ignore regions: an unmatched detection with at
/// least the share min_iou of its own area in one is neither right nor wrong. Class `other` is not
/// evaluated.
DetectionErrors evaluateDetections(const std::vector<TrueFrame>& truth,
                                   const std::vector<DetectedFrame>& detections,
                                   const DetectionOptions& options = {});

}  // namespace roomgraph
