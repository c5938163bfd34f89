// SPDX-License-Identifier: BSD-3-Clause
// Loading of a network, choice of its decoder, preprocessing and inference.
#include "network.h"

#include <algorithm>
#include <filesystem>

#include "input_mapping.h"
#include "label_lists.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/observations/rgbd_channels.h"
#include "trial_process.h"

namespace roomgraph {
namespace {

const cv::Size kRoomInput(320, 240);  // px; of the room detector of training/

/// Input channels of the first convolution; 0: the network has none.
int firstChannels(cv::dnn::Net& net) {
  for (const auto& name : net.getLayerNames()) {
    const auto layer = net.getLayer(net.getLayerId(name));
    if (layer->type == "Convolution" && !layer->blobs.empty() && layer->blobs[0].dims == 4)
      return layer->blobs[0].size[1];
  }
  return 0;
}

}  // namespace

Network::Network(const NetworkSpec& spec) : file_(spec.file) {
  outputs_.file = spec.file;
  // OpenCV's readers of networks crash at some damaged files.
  if (const auto fate = fateOfTrial([&] { load(spec); }); !fate.empty())
    throw InputError(file_ + ": not a network that OpenCV can load: it " + fate + " when it tried to");
  load(spec);
}

void Network::load(const NetworkSpec& spec) {
  try {
    readFiles(spec);
    chooseInputSize(spec.input_size_px);
  } catch (const cv::Exception& error) {
    throw InputError(file_ + ": not a network that OpenCV can load: " + firstLine(error.err));
  }
  if (labels_.empty()) labels_ = knownLabels(spec.format);
  chooseDecoder(spec.format);
}

// The named decoder, if it recognises the output, or else the only one that does.
void Network::chooseDecoder(const std::string& format) {
  const int classes = static_cast<int>(labels_.size());
  decoder_ = format.empty() ? decoderFor(outputs_, classes) : decoderNamed(format);
  if (decoder_ && decoder_->recognises(outputs_, classes)) return;
  throw InputError(file_ + ": the network's output (" + describeShape(outputs_.blobs) + ", " +
                   std::to_string(classes) + " labels" + (labels_file_.empty() ? "" : " in " + labels_file_) +
                   ") fits " +
                   (format.empty() ? "none of the known formats: " + knownFormats()
                                   : "not the format '" + format + "'"));
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
    outputs_.input = darknetInputSize(config);
  } else if (path.extension() == ".onnx") {
    net_ = cv::dnn::readNetFromONNX(file_);
  } else {
    throw InputError(file_ + ": not a network file; known: .onnx, Darknet .weights with its .cfg");
  }
  if (net_.empty()) throw InputError(file_ + ": the file holds no network");
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  output_names_ = net_.getUnconnectedOutLayersNames();
}

bool Network::accepts(cv::Size input, int channels) {
  const int shape[] = {1, channels, input.height, input.width};
  outputs_.blobs = forward(cv::Mat(4, shape, CV_32FC1, cv::Scalar(0)));
  outputs_.input = input;
  return !outputs_.blobs.empty();
}

// An ONNX file does not tell its input size through OpenCV 4.6; a pass over an empty picture does.
void Network::chooseInputSize(int configured) {
  constexpr int kColors = 3;
  std::vector<std::pair<cv::Size, int>> candidates;
  if (firstChannels(net_) == kRgbdChannels) {
    candidates = {{kRoomInput, kRgbdChannels}};
  } else if (configured > 0) {
    candidates.emplace_back(cv::Size(configured, configured), kColors);
  } else if (!outputs_.input.empty()) {
    candidates = {{outputs_.input, kColors}};
  } else {
    if (const int named = sizeFromName(file_)) candidates.emplace_back(cv::Size(named, named), kColors);
    for (const int size : {416, 320, 640, 256, 512}) candidates.emplace_back(cv::Size(size, size), kColors);
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) try {
      if (accepts(candidates[i].first, candidates[i].second)) return;
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

// The built-in list with as many labels as the network has classes.
std::vector<std::string> Network::knownLabels(const std::string& format) const {
  const auto decoders = format.empty() ? networkDecoders() : std::vector{decoderNamed(format)};
  std::vector<std::string> known;
  for (const auto& [name, labels] : labelLists()) {
    const int classes = static_cast<int>(labels.size());
    const auto fits = [&](const auto& decoder) { return decoder->recognises(outputs_, classes); };
    if (std::any_of(decoders.begin(), decoders.end(), fits)) return labels;
    known.push_back(name + " " + std::to_string(labels.size()));
  }
  throw InputError(file_ + ": the network's output (" + describeShape(outputs_.blobs) + ")" +
                   (format.empty() ? "" : ", read as '" + format + "',") +
                   " has the number of classes of no list of labels that comes with the program (" +
                   join(known) + "): put labels.txt beside it, one label a line in the network's order, or " +
                   "name such a file as [detection] labels_file");
}

cv::Mat Network::blobFor(const Frame& frame) const {
  const cv::Mat& bgr = frame.color;
  if (decoder_->usesDepth()) {
    const auto channels = rgbdChannels(bgr, frame.depth, frame.camera, outputs_.input);
    const int shape[] = {1, kRgbdChannels, outputs_.input.height, outputs_.input.width};
    cv::Mat blob(4, shape, CV_32FC1);
    for (int i = 0; i < kRgbdChannels; ++i)
      channels[static_cast<std::size_t>(i)].convertTo(cv::Mat(outputs_.input, CV_32FC1, blob.ptr(0, i)),
                                                      CV_32F, 1 / 255.0);
    return blob;
  }
  const Preprocessing how = decoder_->preprocessing();
  cv::Mat image;
  fitImage(bgr, outputs_.input, how.fit, how.pad).convertTo(image, CV_32FC3);
  cv::subtract(image, how.mean, image);
  cv::divide(image, how.deviation, image);
  return cv::dnn::blobFromImage(image, 1.0, cv::Size(), cv::Scalar(), how.rgb, false);
}

std::vector<RawBox> Network::run(const Frame& frame, const std::vector<int>& wanted, double min_score) {
  const cv::Mat& bgr = frame.color;
  outputs_.blobs = forward(blobFor(frame));
  std::vector<RawBox> boxes;
  const InputMapping mapping = mappingFor(bgr.size(), outputs_.input, decoder_->preprocessing().fit);
  for (RawBox& raw : decoder_->decode(outputs_, {static_cast<int>(labels_.size()), wanted, min_score})) {
    if (std::find(wanted.begin(), wanted.end(), raw.class_index) == wanted.end()) continue;
    raw.box = clipped(mapping.toImage(raw.box), bgr.cols, bgr.rows);
    if (!raw.box.empty()) boxes.push_back(raw);
  }
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const RawBox& a, const RawBox& b) { return a.score > b.score; });
  return boxes;
}

}  // namespace roomgraph
