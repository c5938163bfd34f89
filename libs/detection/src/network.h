// SPDX-License-Identifier: BSD-3-Clause
// One loaded network: format, labels, input size, inference.
#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "decoders.h"
#include "input_mapping.h"

namespace roomgraph {

enum class NetworkFormat { kAuto, kNanodet, kYolox, kDarknet, kAde20k };

/// What the user says about one network.
struct NetworkSpec {
  std::string file;  ///< .onnx, or Darknet .weights with a .cfg of the same name beside it
  NetworkFormat format = NetworkFormat::kAuto;
  std::string labels_file;  ///< empty: labels.txt beside the file, or a known list
  int input_size_px = 0;    ///< 0: from the .cfg, the file's name, or by trying
};

/// Splits "path[:format]". Throws ConfigError that lists the known formats.
NetworkSpec parseNetworkSpec(const std::string& text);

/// A loaded network: image in, boxes out.
class Network {
 public:
  /// Throws InputError with the file and the cause.
  explicit Network(const NetworkSpec& spec);

  const std::vector<std::string>& labels() const { return labels_; }
  bool segments() const { return format_ == NetworkFormat::kAde20k; }
  /// Boxes of the `wanted` label indices in pixels of `bgr`, best first, before non-maximum suppression.
  std::vector<RawBox> run(const cv::Mat& bgr, const std::vector<int>& wanted, double min_score);

 private:
  std::vector<cv::Mat> forward(const cv::Mat& blob);
  void readFiles(const NetworkSpec& spec);
  void chooseInputSize(int configured);
  bool accepts(cv::Size input);
  std::vector<std::string> knownLabels() const;
  NetworkFormat formatFromOutput(int classes) const;
  cv::Mat blobFor(const cv::Mat& bgr) const;
  std::vector<RawBox> decode(const std::vector<int>& wanted, double min_score) const;

  std::string file_;
  std::string labels_file_;  ///< empty: the labels are a known list
  NetworkFormat format_;
  std::vector<std::string> labels_;
  cv::dnn::Net net_;
  std::vector<std::string> output_names_;
  cv::Size input_;
  std::vector<cv::Mat> outputs_;  ///< of the last forward pass
};

}  // namespace roomgraph
