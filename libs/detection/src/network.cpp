// SPDX-License-Identifier: BSD-3-Clause
// Loading, format recognition, preprocessing and inference of a network.
#include "network.h"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "label_lists.h"
#include "network_files.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

struct Preprocessing {
  InputFit fit;
  double pad;
  bool rgb;
  cv::Scalar mean, deviation;  // in the image's BGR order
};

// As each network's authors trained it.
Preprocessing preprocessingOf(NetworkFormat format) {
  switch (format) {
    case NetworkFormat::kNanodet:
      return {InputFit::kStretch, 0, false, {103.53, 116.28, 123.675}, {57.375, 57.12, 58.395}};
    case NetworkFormat::kYolox:
      return {InputFit::kLetterboxTopLeft, 114, false, {}, cv::Scalar::all(1)};
    case NetworkFormat::kAde20k:
      return {InputFit::kStretch, 0, true, cv::Scalar::all(127.5), cv::Scalar::all(127.5)};
    default:
      return {InputFit::kStretch, 0, true, {}, cv::Scalar::all(255)};
  }
}

// N x C view of a blob 1 x N x C (or N x C).
cv::Mat rows(const cv::Mat& blob) {
  if (blob.dims == 3 && blob.size[0] == 1)
    return cv::Mat(blob.size[1], blob.size[2], blob.type(), const_cast<uchar*>(blob.data));
  return blob;
}

}  // namespace

Network::Network(const NetworkSpec& spec) : file_(spec.file), format_(spec.format) {
  try {
    readFiles(spec);
    chooseInputSize(spec.input_size_px);
  } catch (const cv::Exception& error) {
    throw InputError(file_ + ": not a network that OpenCV can load: " + firstLine(error.err));
  }
  if (labels_.empty()) labels_ = knownLabels();
  const NetworkFormat found = formatFromOutput(static_cast<int>(labels_.size()));
  if (format_ == NetworkFormat::kAuto) format_ = found;
  if (format_ == NetworkFormat::kAuto || format_ != found)
    throw InputError(file_ + ": the network's output (" + describeShape(outputs_) + ", " +
                     std::to_string(labels_.size()) + " labels" +
                     (labels_file_.empty() ? "" : " in " + labels_file_) + ") fits " +
                     (format_ == NetworkFormat::kAuto ? "none of the known formats: " + knownFormats()
                                                      : "not the format '" + toString(format_) + "'"));
}

void Network::readFiles(const NetworkSpec& spec) {
  requireFile(file_, "network");
  const std::filesystem::path path(file_);
  labels_file_ = spec.labels_file;
  if (const auto beside = path.parent_path() / "labels.txt";
      labels_file_.empty() && std::filesystem::is_regular_file(beside))
    labels_file_ = beside.string();
  if (!labels_file_.empty()) labels_ = readLabels(labels_file_);
  if (path.extension() == ".weights") {
    const std::string config = std::filesystem::path(path).replace_extension(".cfg").string();
    requireFile(config, "Darknet configuration");
    net_ = cv::dnn::readNetFromDarknet(config, file_);
    input_ = darknetInputSize(config);
  } else if (path.extension() == ".onnx") {
    net_ = cv::dnn::readNetFromONNX(file_);
  } else {
    throw InputError(file_ + ": not a network file; known: .onnx, Darknet .weights with its .cfg");
  }
  if (net_.empty()) throw InputError(file_ + ": the file holds no network");
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  output_names_ = net_.getUnconnectedOutLayersNames();
}

bool Network::accepts(cv::Size input) {
  const int shape[] = {1, 3, input.height, input.width};
  outputs_ = forward(cv::Mat(4, shape, CV_32FC1, cv::Scalar(0)));
  input_ = input;
  return !outputs_.empty();
}

// An ONNX file does not tell its input size through OpenCV 4.6; a pass over an empty picture does.
void Network::chooseInputSize(int configured) {
  std::vector<cv::Size> candidates;
  if (configured > 0) {
    candidates = {cv::Size(configured, configured)};
  } else if (!input_.empty()) {
    candidates = {input_};
  } else {
    if (const int named = sizeFromName(file_)) candidates.emplace_back(named, named);
    for (const int size : {416, 320, 640, 256, 512}) candidates.emplace_back(size, size);
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) try {
      if (accepts(candidates[i])) return;
    } catch (const cv::Exception&) {
      if (i + 1 == candidates.size()) throw;
    }
  throw InputError(file_ + ": the network has no output");
}

std::vector<cv::Mat> Network::forward(const cv::Mat& blob) {
  net_.setInput(blob);
  std::vector<cv::Mat> outputs;
  net_.forward(outputs, output_names_);
  return outputs;
}

// The list that comes with the program and has as many labels as the network has classes.
std::vector<std::string> Network::knownLabels() const {
  std::vector<std::string> known;
  for (const auto& [name, labels] : labelLists()) {
    if (formatFromOutput(static_cast<int>(labels.size())) != NetworkFormat::kAuto) return labels;
    known.push_back(name + " " + std::to_string(labels.size()));
  }
  throw InputError(file_ + ": the network's output (" + describeShape(outputs_) +
                   ") has the number of classes of no list of labels that comes with the program (" +
                   join(known) + "): put labels.txt beside it, one label a line in the network's order, or " +
                   "name such a file as [detection] labels_file");
}

NetworkFormat Network::formatFromOutput(int classes) const {
  const cv::Mat& first = outputs_.front();
  if (first.dims == 4) return first.size[1] == classes ? NetworkFormat::kAde20k : NetworkFormat::kAuto;
  const cv::Mat table = rows(first);
  if (table.dims != 2) return NetworkFormat::kAuto;
  if (std::filesystem::path(file_).extension() == ".weights")
    return table.cols == classes + 5 ? NetworkFormat::kDarknet : NetworkFormat::kAuto;
  if (table.cols == classes + 5) return NetworkFormat::kYolox;
  return table.cols == classes + 32 ? NetworkFormat::kNanodet : NetworkFormat::kAuto;
}

cv::Mat Network::blobFor(const cv::Mat& bgr) const {
  const Preprocessing how = preprocessingOf(format_);
  cv::Mat image;
  fitImage(bgr, input_, how.fit, how.pad).convertTo(image, CV_32FC3);
  cv::subtract(image, how.mean, image);
  cv::divide(image, how.deviation, image);
  return cv::dnn::blobFromImage(image, 1.0, cv::Size(), cv::Scalar(), how.rgb, false);
}

std::vector<RawBox> Network::decode(const std::vector<int>& wanted, double min_score) const {
  const int classes = static_cast<int>(labels_.size());
  std::vector<RawBox> boxes;
  for (const cv::Mat& output : outputs_) {
    std::vector<RawBox> found;
    switch (format_) {
      case NetworkFormat::kNanodet:
        found = decodeNanodet(rows(output), input_, classes, min_score);
        break;
      case NetworkFormat::kYolox:
        found = decodeYolox(rows(output), input_, min_score);
        break;
      case NetworkFormat::kDarknet:
        found = decodeDarknet(rows(output), input_, min_score);
        break;
      default:
        found = decodeSegmentation(output, input_, wanted, min_score);
    }
    boxes.insert(boxes.end(), found.begin(), found.end());
  }
  return boxes;
}

std::vector<RawBox> Network::run(const cv::Mat& bgr, const std::vector<int>& wanted, double min_score) {
  outputs_ = forward(blobFor(bgr));
  std::vector<RawBox> boxes;
  const InputMapping mapping = mappingFor(bgr.size(), input_, preprocessingOf(format_).fit);
  for (RawBox& raw : decode(wanted, min_score)) {
    if (std::find(wanted.begin(), wanted.end(), raw.class_index) == wanted.end()) continue;
    raw.box = clipped(mapping.toImage(raw.box), bgr.cols, bgr.rows);
    if (!raw.box.empty()) boxes.push_back(raw);
  }
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const RawBox& a, const RawBox& b) { return a.score > b.score; });
  return boxes;
}

}  // namespace roomgraph
