// SPDX-License-Identifier: BSD-3-Clause
// Interface of the decoders: how a format of detection networks wants its input, and what its outputs mean.
#pragma once

#include <mrpt/rtti/CObject.h>

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "roomgraph/geometry/box.h"

namespace roomgraph {

/// How a camera image fills the rectangular input of a network.
enum class InputFit {
  kStretch,           ///< each axis scaled on its own
  kLetterboxTopLeft,  ///< both axes scaled alike, image in the top left corner, the rest padded
};

/// How a network's input is made of an image: resized, then (pixel - mean) / deviation per channel. The defaults
/// give RGB in [0, 1].
struct Preprocessing {
  InputFit fit = InputFit::kStretch;
  double pad = 0;                                 ///< value of the padding, before mean and deviation
  bool rgb = true;                                ///< order of the network's channels; false: BGR
  cv::Scalar mean, deviation{255, 255, 255, 255};  ///< in the image's order, BGR
};

/// A box from a network, before non-maximum suppression.
struct RawBox {
  Box2 box;  ///< px of the network's input
  int class_index = -1;
  double score = 0;
  cv::Mat mask;  ///< CV_8UC1 (0 / 255) over the box at the network's own resolution, or empty
  int network = 0;  ///< of several, which one found it; decoders leave it alone
};

/// Outputs of a network for one image.
struct NetworkOutputs {
  std::filesystem::path file;  ///< of the network: ".weights" marks Darknet's outputs
  cv::Size input;              ///< px
  std::vector<cv::Mat> blobs;  ///< from OpenCV's dnn module, never empty
};

/// Which boxes are wanted.
struct DecodingTask {
  int classes = 0;          ///< of the network
  std::vector<int> wanted;  ///< class indices; boxes of other classes may be left out
  double min_score = 0;
};

/// One format of network outputs. Implementations have no state; they are registered with MRPT's class factory,
/// and each registered one takes part: a network is decoded by the one that recognises its outputs.
class NetworkDecoder : public mrpt::rtti::CObject {
  DEFINE_VIRTUAL_MRPT_OBJECT(NetworkDecoder)
 public:
  /// Name of the format in the configuration (`models = FILE:NAME`), each once.
  virtual std::string name() const = 0;
  virtual Preprocessing preprocessing() const = 0;
  /// Whether outputs of this shape are this format's, given the number of classes.
  virtual bool recognises(const NetworkOutputs& outputs, int classes) const = 0;
  /// Boxes in pixels of the network's input. Empty for outputs that recognises() refuses.
  virtual std::vector<RawBox> decode(const NetworkOutputs& outputs, const DecodingTask& task) const = 0;
  /// True for segmentation networks: of their labels only those in `[detection] segmentation_labels` are used.
  virtual bool segments() const { return false; }
  /// True for networks whose input is rgbdChannels(), in [0, 1]; preprocessing() then has no part in it.
  virtual bool usesDepth() const { return false; }
};

}  // namespace roomgraph
