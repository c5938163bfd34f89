// SPDX-License-Identifier: BSD-3-Clause
// Images of ROS messages as OpenCV matrices.
#pragma once

#include <opencv2/core/mat.hpp>

#include "messages.h"

namespace roomgraph::bags {

/// Colour image of any encoding that is known: CV_8UC3 (BGR) or CV_8UC1, pixels of its own. Throws
/// BadMessage: encoding not known, fewer bytes than pixels, compressed data damaged.
cv::Mat colorImageOf(const ImageMessage& image, bool compressed);

/// Depth: CV_16UC1 (values as they are, mm by REP 118) or CV_32FC1 (m). Throws BadMessage like
/// colorImageOf().
cv::Mat depthImageOf(const ImageMessage& image, bool compressed);

/// What an encoding (of a compressed image: its format) says about an image, as far as it tells.
enum class ImageContent { kColor, kGray, kDepth, kUnknown };
ImageContent contentOf(const std::string& encoding);

}  // namespace roomgraph::bags
