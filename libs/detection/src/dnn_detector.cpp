// SPDX-License-Identifier: BSD-3-Clause
// Networks run on a frame: label mapping, suppression, clipping and masks.
#include "dnn_detector.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <set>

#include "detection_bytes.h"
#include "network.h"
#include "roomgraph/core/result_store.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/detection/detection_record.h"
#include "suppress.h"

namespace roomgraph {

IMPLEMENTS_MRPT_OBJECT(DnnDetector, Detector, roomgraph)

namespace {

// Which database class (index) each label of a network belongs to, -1: none.
std::vector<int> classOfLabel(const Network& network, const ObjectDatabase& database,
                              const std::vector<std::string>& segmentation_labels) {
  std::vector<int> classes;
  for (const std::string& label : network.labels()) {
    const bool allowed =
        !network.segments() ||
        std::find(segmentation_labels.begin(), segmentation_labels.end(), label) != segmentation_labels.end();
    const ObjectModel* model = allowed ? database.byLabel(label) : nullptr;
    classes.push_back(model ? static_cast<int>(model - database.models().data()) : -1);
  }
  return classes;
}

// Advice to a user without a network; everything but objects works without.
const char* const kNoNetwork =
    "no network, so no objects: name a weights file as [detection] models (--set detection.models=FILE); "
    "suitable: NanoDet-Plus-m-1.5x (github.com/RangiLyu/nanodet), YOLOX-Nano "
    "(github.com/Megvii-BaseDetection/YOLOX), Yolo-Fastest-1.1-xl (github.com/dog-qiuqiu/Yolo-Fastest); for "
    "doors DeepLabV3-MobileNetV2 trained on ADE20K (github.com/mlcommons/mobile_models)";

cv::Mat maskOver(const Box2& box, const cv::Mat& cells) {
  cv::Mat mask;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(box.width()))),
                      std::max(1, static_cast<int>(std::lround(box.height()))));
  if (!cells.empty()) cv::resize(cells, mask, size, 0, 0, cv::INTER_NEAREST);
  return mask;
}

}  // namespace

void DnnDetector::declareParameters(ParameterVisitor& v) {
  v.add(
      "models", models_,
      {.doc =
           "Network files, each path[:format][@rate] with the format auto, nanodet, yolox, darknet, ade20k or that "
           "of a plug-in. All run on each image and their boxes are fused; one with a rate, as in "
           "doors.onnx@2, on at most so many images a second; boxes of classes that only it finds are carried on between, over "
           "max_carried_frames at most. Darknet .weights need the .cfg of the same name beside them.",
       .file = true});
  v.add("labels_file", labels_file_,
        {.doc = "File with one label per line. Empty: labels.txt beside each network, or without that the "
                "labels of "
                "COCO or ADE20K, by the number of classes.",
         .file = true});
  v.add(
      "segmentation_labels", segmentation_labels_,
      {.doc = "Labels that are taken from a segmentation network; networks that give boxes are better at the "
              "others."});
  v.add("input_size_px", input_size_px_,
        {.doc = "Side of the networks' square input. 0: as the network, its .cfg or its file name says.",
         .unit = "px",
         .min = 0,
         .max = 4096});
  v.add("score_threshold", score_threshold_,
        {.doc = "Detections with a smaller score are left out.", .min = 0.01, .max = 1});
  v.add(
      "nms_threshold", nms_threshold_,
      {.doc = "Of two boxes of one class whose IoU is larger only the better is kept; those of several networks are fused.", .min = 0, .max = 1});
  v.add(
      "twin_threshold", twin_threshold_,
      {.doc =
           "Of two boxes of different classes whose IoU is larger only the better is kept. 1: both are kept, "
           "and their geometry decides.",
       .min = 0,
       .max = 1});
}

void DnnDetector::prepare() {
  networks_.clear();
  clocks_.clear();
  chosen_.clear();
  unsought_.clear();
  calibrations_.clear();
  std::vector<std::string> names, hashes;
  for (const std::string& text : models_) {
    NetworkSpec spec = parseNetworkSpec(text);
    spec.labels_file = labels_file_;
    spec.input_size_px = input_size_px_;
    networks_.push_back(std::make_shared<Network>(spec));
    clocks_.emplace_back(spec.rate_hz);
    calibrations_.push_back(ScoreCalibration::beside(spec.file));
    names.push_back(std::filesystem::path(spec.file).stem().string());
    hashes.push_back(fileHash(spec.file));
    if (const std::string& scores = calibrations_.back().hash(); !scores.empty()) hashes.back() += "~" + scores;
  }
  mapLabels();
  identity_ = {join(names, "+"), join(hashes, "+"), score_threshold_, nms_threshold_};
}

void DnnDetector::setDatabase(const ObjectDatabase& database) {
  database_ = &database;
  mapLabels();
}

void DnnDetector::mapLabels() {
  classes_.clear();
  if (!database_) return;
  for (const auto& network : networks_) classes_.push_back(classOfLabel(*network, *database_, segmentation_labels_));
}

DetectorIdentity DnnDetector::identity() const {
  return identity_;
}

// Of each network, whether it runs on the frame of this time; frames come in order, each once or more.
DnnDetector::Chosen DnnDetector::dueAt(double t) {
  const std::lock_guard one(choosing_);
  if (const auto known = chosen_.find(t); known != chosen_.end()) return known->second;
  Chosen out;
  for (RateClock& clock : clocks_) {
    out.push_back(clock.due(t));
    if (out.back()) clock.ran(t);
  }
  return chosen_[t] = out;
}

void DnnDetector::forgetBefore(double t) {
  const std::lock_guard one(choosing_);
  chosen_.erase(chosen_.begin(), chosen_.lower_bound(t));
}

// Names of the classes that only the other networks could have found.
std::vector<std::string> DnnDetector::unsoughtWithout(const Chosen& chosen) const {
  std::set<int> sought, all;
  for (std::size_t k = 0; k < classes_.size(); ++k)
    for (const int index : classes_[k]) {
      if (index < 0) continue;
      all.insert(index);
      if (chosen[k]) sought.insert(index);
    }
  std::vector<std::string> out;
  for (const int index : all)
    if (!sought.contains(index)) out.push_back(database_->models()[static_cast<std::size_t>(index)].class_name);
  return out;
}

// Others fail, and take no network's turn.
bool DnnDetector::usable(const Frame& frame) {
  return !frame.color.empty() && frame.color.type() == CV_8UC3;
}

bool DnnDetector::due(const Frame& frame) {
  if (!usable(frame) || networks_.empty()) return true;
  const Chosen chosen = dueAt(frame.t);
  return std::find(chosen.begin(), chosen.end(), 1) != chosen.end();
}

Outcome<std::vector<Detection>> DnnDetector::detect(const Frame& frame) {
  unsought_.clear();
  if (usable(frame)) unsought_ = unsoughtWithout(dueAt(frame.t));
  forgetBefore(frame.t);
  return recalled(
      results_, "boxes", frame.t,
      [&] {
        auto found = foreseen_.take(frame.t);
        return found ? std::move(*found) : run(frame);
      },
      bytesOf, detectionsFrom);
}

bool DnnDetector::foresee(const Frame& frame) {
  if (!usable(frame)) return false;
  if (!results_ || !results_->recalling()) foreseen_.put(frame.t, run(frame));
  return true;
}

Outcome<std::vector<Detection>> DnnDetector::run(const Frame& frame) {
  using Result = Outcome<std::vector<Detection>>;
  const std::lock_guard one(running_);
  if (networks_.empty() || !database_) return Result::failure(kNoNetwork);
  if (!usable(frame)) return Result::failure("no colour image");

  std::vector<RawBox> boxes;
  std::vector<std::string> labels;
  std::vector<Detection> others;  // of labels that no class has
  const Chosen chosen = dueAt(frame.t);
  for (std::size_t k = 0; k < networks_.size(); ++k) {
    if (!chosen[k]) continue;
    const auto& network = networks_[k];
    const std::vector<int>& classes = classes_[k];
    std::vector<int> wanted;
    for (int i = 0; i < static_cast<int>(classes.size()); ++i)
      if (classes[i] >= 0 || !network->segments()) wanted.push_back(i);
    for (RawBox& raw : network->run(frame, wanted, calibrations_[k].leastScore(score_threshold_))) {
      const std::string& label = network->labels()[raw.class_index];
      raw.class_index = classes[raw.class_index];
      raw.network = static_cast<int>(k);
      if (raw.class_index >= 0)
        raw.score = calibrations_[k].probability(database_->models()[raw.class_index].class_name, raw.score);
      if (raw.score < score_threshold_) continue;
      if (raw.class_index < 0) {
        others.push_back({.box = raw.box, .label = label, .score = raw.score});
        continue;
      }
      labels.push_back(label);
      boxes.push_back(raw);
    }
  }
  std::vector<Detection> detections;
  const std::vector<int> kept = fuseNetworks(boxes, suppressPerClass(boxes, nms_threshold_), nms_threshold_);
  for (const int i : suppressTwins(boxes, kept, twin_threshold_))
    detections.push_back({boxes[i].box,
                          database_->models()[boxes[i].class_index].class_name,
                          labels[i],
                          std::clamp(boxes[i].score, 0.0, 1.0),
                          maskOver(boxes[i].box, boxes[i].mask),
                          {}});
  setRivals(detections, others, *database_);
  return detections;
}

}  // namespace roomgraph
