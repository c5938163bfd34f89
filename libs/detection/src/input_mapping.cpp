// SPDX-License-Identifier: BSD-3-Clause
// Stretch and letterbox resizing, and box coordinates under them.
#include "input_mapping.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roomgraph {

Box2 InputMapping::toImage(const Box2& input) const {
  return {input.u_min / scale_x, input.v_min / scale_y, input.u_max / scale_x, input.v_max / scale_y};
}

InputMapping mappingFor(cv::Size image, cv::Size input, InputFit fit) {
  const double x = static_cast<double>(input.width) / image.width;
  const double y = static_cast<double>(input.height) / image.height;
  if (fit == InputFit::kStretch) return {x, y};
  return {std::min(x, y), std::min(x, y)};
}

cv::Mat fitImage(const cv::Mat& image, cv::Size input, InputFit fit, double pad) {
  const InputMapping mapping = mappingFor(image.size(), input, fit);
  const cv::Size used(
      std::clamp(static_cast<int>(std::lround(image.cols * mapping.scale_x)), 1, input.width),
      std::clamp(static_cast<int>(std::lround(image.rows * mapping.scale_y)), 1, input.height));
  cv::Mat resized;
  cv::resize(image, resized, used, 0, 0, cv::INTER_LINEAR);
  if (used == input) return resized;
  cv::Mat padded(input, image.type(), cv::Scalar::all(pad));
  resized.copyTo(padded(cv::Rect(cv::Point(0, 0), used)));
  return padded;
}

}  // namespace roomgraph
