// SPDX-License-Identifier: BSD-3-Clause
// Interface of object detection in a frame, and the identity of a detector.
#pragma once

#include <string>
#include <vector>

#include "roomgraph/core/outcome.h"
#include "roomgraph/core/stage.h"
#include "roomgraph/observations/CObservationDetections.h"
#include "roomgraph/observations/detection.h"
#include "roomgraph/observations/frame.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Origin of detections, by which it is decided whether recorded ones may be used again.
struct DetectorIdentity {
  std::string model;  ///< names of the networks, joined by "+"; or what made the recording
  std::string hash;   ///< of the weights files (fileHash(), joined by "+", after each "~" and that of its scores file); empty: no files
  double score_threshold = 0, nms_threshold = 0;
};

/// Frame in, detections out (method.md sec. 1.1).
class Detector : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(Detector)
 public:
  /// The classes of interest; called before prepare(). The database outlives the detector.
  virtual void setDatabase(const ObjectDatabase& database) = 0;
  /// Detections recorded in the rawlog, as they are read.
  virtual void feed(const CObservationDetections& recorded) { (void)recorded; }
  /// True while there is neither network nor record; then detect() need not be called.
  virtual bool idle() const { return false; }
  /// Detections of classes in the database, boxes clipped to the image, best first; or why there are none
  /// ("no colour image", "no record at this time"). The caller decides on which frames the detector runs.
  virtual Outcome<std::vector<Detection>> detect(const Frame& frame) = 0;
  /// Whether detect() would look for anything in this frame. When not, it need not be called, and nothing was looked for. Asked
  /// in the order of the frames.
  virtual bool due(const Frame& frame) {
    (void)frame;
    return true;
  }
  /// Classes of the database that the last detect() did not look for, as their network runs on fewer frames: boxes of the frames
  /// before may be carried on, and that none was found says nothing.
  virtual std::vector<std::string> unsought() const { return {}; }
  /// A frame on which detect() will be called: it may find its boxes now and keep them until then. Called after prepare(), in
  /// the order of the frames, beside all other calls, or not at all; the outcome is the same. Returns false when nothing
  /// will be found in it.
  virtual bool foresee(const Frame& frame) {
    (void)frame;
    return true;
  }
  virtual DetectorIdentity identity() const { return {}; }
  /// Warning for the user about the detections of this run; empty without one.
  virtual std::string warning() const { return {}; }
};

}  // namespace roomgraph
