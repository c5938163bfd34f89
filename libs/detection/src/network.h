// SPDX-License-Identifier: BSD-3-Clause
// One loaded network: its decoder, labels, input size, and running it on an image.
#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "network_decoders.h"
#include "network_files.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// A loaded network: image in, boxes out.
class Network {
 public:
  /// Throws InputError with the file and the cause.
  explicit Network(const NetworkSpec& spec);

  const std::vector<std::string>& labels() const { return labels_; }
  bool segments() const { return decoder_->segments(); }
  /// Boxes of the `wanted` label indices in pixels of the frame, best first, before non-maximum suppression.
  /// The frame has a colour image.
  std::vector<RawBox> run(const Frame& frame, const std::vector<int>& wanted, double min_score);

 private:
  void load(const NetworkSpec& spec);
  std::vector<cv::Mat> forward(const cv::Mat& blob);
  void readFiles(const NetworkSpec& spec);
  void chooseInputSize(int configured);
  bool accepts(cv::Size input, int channels);
  std::vector<std::string> knownLabels(const std::string& format) const;
  void chooseDecoder(const std::string& format);
  cv::Mat blobFor(const Frame& frame) const;

  std::string file_;
  std::string labels_file_;  ///< empty: the labels are a known list
  NetworkDecoderPtr decoder_;
  std::vector<std::string> labels_;
  cv::dnn::Net net_;
  std::vector<std::string> output_names_;
  NetworkOutputs outputs_;  ///< of the last forward pass
};

}  // namespace roomgraph
