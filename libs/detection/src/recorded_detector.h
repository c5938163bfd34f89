// SPDX-License-Identifier: BSD-3-Clause
// Detector that replays boxes recorded in a rawlog or a file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "roomgraph/detection/detector.h"

namespace roomgraph {

/// Boxes of one recorded image.
struct RecordedBoxes {
  std::string image_label;       ///< sensor label of the camera; empty: any
  std::vector<Detection> boxes;  ///< class_name is not filled in yet
  std::vector<std::string> unsought{};  ///< classes that were not looked for
  int image_width = 0, image_height = 0;  ///< px; 0: not recorded
  bool carried = false;                   ///< no detector looked at this image: boxes of others are carried to it
};

/// Recorded boxes by time, seconds.
using DetectionRecords = std::multimap<double, RecordedBoxes>;

/// Reads JSON lines {"timestamp", "boxes": [{"class", "score", "bbox": [u0, v0, u1, v1]}]}, with "track" (an
/// id) and "mask" (a grey picture as large as the image, relative to the file; then the box is the mask's)
/// where the source has them, "rival" ({"label", "score"}: what of no class the box was taken for as well), and "unsought": classes that were not looked for; or text lines
/// `timestamp cocoID x y w h score`, whichever the file holds. Throws InputError with file, line and cause.
DetectionRecords readDetectionFile(const std::string& file);

/// Reads the detections of a rawlog (`run --save-detections`), in its order; other records are stepped over.
/// Throws InputError with file and cause.
std::vector<CObservationDetections> readDetectionRawlog(const std::string& file);

/// Replays detections: from records of the rawlog (fed as they are read), from a file, or both. A file that
/// is a rawlog of detections stands for those in the recording, which are then left out.
class RecordedDetector : public Detector {
  DEFINE_MRPT_OBJECT(RecordedDetector, roomgraph)
 public:
  void declareParameters(ParameterVisitor& visitor) override;
  /// Declares all parameters but the score: where the records are.
  void declareSource(ParameterVisitor& visitor);
  void setScoreThreshold(double smallest) { score_threshold_ = smallest; }
  void setDatabase(const ObjectDatabase& database) override { database_ = &database; }
  void prepare() override;
  void feed(const CObservationDetections& recorded) override;
  /// The records nearest in time to the frame (and of its camera), when within the tolerance; also those that follow
  /// the frame in the rawlog, when they were fed before this call.
  Outcome<std::vector<Detection>> detect(const Frame& frame) override;
  /// False on images of which it is recorded that no detector looked at them.
  bool due(const Frame& frame) override {
    const RecordedBoxes* record = nearest(frame);
    return !record || !record->carried;
  }
  /// Of the records read last: the file's name and hash, or the origin stored in the rawlog.
  std::vector<std::string> unsought() const override { return unsought_; }
  DetectorIdentity identity() const override { return identity_; }
  /// Warns when records were made with a stricter threshold than the configured one, or none matches a frame.
  std::string warning() const override;
  /// Whether no record is known so far.
  bool empty() const { return records_.empty(); }

 private:
  void take(const CObservationDetections& recorded);
  const RecordedBoxes* nearest(const Frame& frame) const;
  std::string mismatch() const;
  std::string lateness() const;

  std::string other_size_;  ///< of the images that boxes were recorded of, in words
  std::string file_;
  double tolerance_s_ = 0.02;
  double score_threshold_ = 0.35;

  const ObjectDatabase* database_ = nullptr;
  DetectionRecords records_;
  DetectorIdentity identity_;
  std::vector<std::string> unsought_;  ///< of the last frame
  std::string threshold_warning_;
  int frames_ = 0, matched_ = 0;  ///< frames in all; with a record
  int late_ = 0;                  ///< records that came after later frames than their own
  double latest_by_s_ = 0;
  double first_frame_t_ = 0, last_frame_t_ = 0;
  std::string frame_label_;  ///< of the last one
  bool from_rawlog_ = false;  ///< the file is a rawlog
};

}  // namespace roomgraph
