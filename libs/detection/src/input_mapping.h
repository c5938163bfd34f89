// SPDX-License-Identifier: BSD-3-Clause
// Mapping between a camera image and the input of a network.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "roomgraph/detection/network_decoder.h"

namespace roomgraph {

/// Image pixel = input pixel / scale, per axis: the image always starts at the input's top left corner.
struct InputMapping {
  double scale_x = 1, scale_y = 1;
  Box2 toImage(const Box2& input) const;
};

InputMapping mappingFor(cv::Size image, cv::Size input, InputFit fit);

/// The image resized into an input of the given size (same type), padded with `pad` in all channels.
cv::Mat fitImage(const cv::Mat& image, cv::Size input, InputFit fit, double pad);

}  // namespace roomgraph
