// SPDX-License-Identifier: BSD-3-Clause
// Recorded boxes matched to frames by time and camera; warnings about thresholds.
#include "recorded_detector.h"

#include <mrpt/core/Clock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>

#include "roomgraph/detection/detection_record.h"
#include "suppress.h"

namespace roomgraph {
namespace {

constexpr double kKept_s = 60;  // of records before a frame: more than frames and their clocks are ever out of order

}  // namespace

IMPLEMENTS_MRPT_OBJECT(RecordedDetector, Detector, roomgraph)

void RecordedDetector::declareSource(ParameterVisitor& v) {
  v.add(
      "file", file_,
      {.doc =
           "File of recorded boxes: detections.jsonl, lines `timestamp cocoID x y w h score`, or a rawlog of "
           "`run --save-detections`, which stands for those inside the recording. Empty: only those inside "
           "the recording.",
       .file = true});
  v.add("tolerance_s", tolerance_s_,
        {.doc = "Largest time between a frame and its record of boxes.", .unit = "s", .min = 0, .max = 10});
}

void RecordedDetector::declareParameters(ParameterVisitor& v) {
  declareSource(v);
  v.add("score_threshold", score_threshold_,
        {.doc = "Detections with a smaller score are left out.", .min = 0, .max = 1});
}

void RecordedDetector::prepare() {
  records_.clear();
  threshold_warning_.clear();
  frames_ = matched_ = late_ = 0;
  latest_by_s_ = 0;
  identity_ = {"", "", score_threshold_, 0};
  from_rawlog_ = std::filesystem::path(file_).extension() == ".rawlog";
  if (file_.empty()) return;
  if (from_rawlog_) {
    for (const auto& recorded : readDetectionRawlog(file_)) take(recorded);
    return;
  }
  records_ = readDetectionFile(file_);
  identity_.model = std::filesystem::path(file_).filename().string();
  identity_.hash = fileHash(file_);
}

void RecordedDetector::feed(const CObservationDetections& recorded) {
  if (from_rawlog_) return;
  const double behind_s = last_frame_t_ - mrpt::Clock::toDouble(recorded.timestamp);
  if (frames_ > 0 && behind_s > tolerance_s_) {
    ++late_;
    latest_by_s_ = std::max(latest_by_s_, behind_s);
  }
  take(recorded);
}

void RecordedDetector::take(const CObservationDetections& recorded) {
  records_.emplace(mrpt::Clock::toDouble(recorded.timestamp),
                   RecordedBoxes{recorded.image_label, detectionsOf(recorded), recorded.unsought,
                                 static_cast<int>(recorded.image_width), static_cast<int>(recorded.image_height)});
  const double recorded_threshold = static_cast<double>(recorded.score_threshold);
  identity_ = {recorded.model, recorded.model_hash, std::max(score_threshold_, recorded_threshold),
               static_cast<double>(recorded.nms_threshold)};
  if (recorded_threshold <= score_threshold_ + 1e-6 || !threshold_warning_.empty()) return;
  std::ostringstream text;
  text << "the recorded detections (" << recorded.model << ") hold no score below " << recorded_threshold
       << "; [detection] score_threshold = " << score_threshold_ << " asks for more: run the network again";
  threshold_warning_ = text.str();
}

const RecordedBoxes* RecordedDetector::nearest(const Frame& frame) const {
  const RecordedBoxes* best = nullptr;
  double distance_s = std::numeric_limits<double>::infinity();
  const auto end = records_.upper_bound(frame.t + tolerance_s_);
  for (auto it = records_.lower_bound(frame.t - tolerance_s_); it != end; ++it) {
    const std::string& label = it->second.image_label;
    if (!label.empty() && !frame.sensor_label.empty() && label != frame.sensor_label) continue;
    const double distance = std::abs(it->first - frame.t);
    if (distance >= distance_s) continue;
    distance_s = distance;
    best = &it->second;
  }
  return best;
}

std::string RecordedDetector::warning() const {
  if (!threshold_warning_.empty()) return threshold_warning_;
  const std::string all = mismatch();
  return all.empty() ? lateness() : all;
}

std::string RecordedDetector::lateness() const {
  if (late_ == 0) return "";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "boxes that came after images of up to " << latest_by_s_
       << " s later, too late for their own: of " << late_ << (late_ == 1 ? " image" : " images")
       << "; a larger [pipeline] lookahead_s waits for them";
  return text.str();
}

// Why no frame had a record, although there were frames.
std::string RecordedDetector::mismatch() const {
  if (frames_ == 0 || matched_ > 0) return "";
  if (!other_size_.empty()) return other_size_ + "; objects are not mapped";
  if (records_.empty())
    return "no recorded boxes: the rawlog holds none, and [detection] file names none; objects are not "
           "mapped";
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "none of the " << records_.size()
       << " images with recorded boxes (" << records_.begin()->first << " to " << records_.rbegin()->first
       << " s, camera '" << records_.begin()->second.image_label << "') is one of the " << frames_
       << " frames (" << first_frame_t_ << " to " << last_frame_t_ << " s, camera '" << frame_label_
       << "'): stamps may differ by [detection] tolerance_s = " << tolerance_s_ << " s, and the camera must "
       << "be the same; objects are not mapped";
  return text.str();
}

namespace {

// From the recorded image to the frame's, along u and v; nothing when one is no smaller copy of the other.
std::optional<Eigen::Vector2d> scaleOf(const RecordedBoxes& record, const PinholeCamera& camera) {
  constexpr double kSameAspect = 0.02;
  if (record.image_width <= 0 || record.image_height <= 0) return Eigen::Vector2d::Ones();
  const Eigen::Vector2d scale(static_cast<double>(camera.width) / record.image_width,
                              static_cast<double>(camera.height) / record.image_height);
  if (std::abs(scale.x() / scale.y() - 1) > kSameAspect) return std::nullopt;
  return scale;
}

Box2 scaled(const Box2& box, const Eigen::Vector2d& scale) {
  return {box.u_min * scale.x(), box.v_min * scale.y(), box.u_max * scale.x(), box.v_max * scale.y()};
}

}  // namespace

Outcome<std::vector<Detection>> RecordedDetector::detect(const Frame& frame) {
  using Result = Outcome<std::vector<Detection>>;
  if (frames_++ == 0) first_frame_t_ = frame.t;
  last_frame_t_ = frame.t;
  frame_label_ = frame.sensor_label;
  const RecordedBoxes* record = nearest(frame);
  unsought_ = record ? record->unsought : std::vector<std::string>{};
  if (!record || !database_) {
    std::ostringstream reason;
    reason << "no recorded detections within " << tolerance_s_ << " s of the frame";
    return Result::failure(reason.str());
  }
  const auto scale = scaleOf(*record, frame.camera);
  if (!scale) {
    other_size_ = "recorded detections are of an image of " + std::to_string(record->image_width) + "x" +
                  std::to_string(record->image_height) + " px, which is not that of the frame";
    return Result::failure(other_size_);
  }
  ++matched_;
  records_.erase(records_.begin(), records_.lower_bound(frame.t - kKept_s));
  std::vector<Detection> detections, others;
  for (Detection detection : record->boxes) {
    const ObjectModel* model = database_->byLabel(detection.label);
    if (!model) model = database_->find(detection.label);
    detection.box = clipped(scaled(detection.box, *scale), frame.camera.width, frame.camera.height);
    if (!(detection.score >= score_threshold_) || detection.box.empty()) continue;
    if (model) detection.class_name = model->class_name;
    // Boxes of such a class can only have been carried to the frame, and are carried again.
    if (std::find(unsought_.begin(), unsought_.end(), detection.class_name) != unsought_.end()) continue;
    (model ? detections : others).push_back(detection);
  }
  setRivals(detections, others, *database_);
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  return detections;
}

}  // namespace roomgraph
