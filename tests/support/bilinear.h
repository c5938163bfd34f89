// SPDX-License-Identifier: BSD-3-Clause
// Grey value between the pixels of a picture, as rendered test scenes need it.
#pragma once

#include <algorithm>
#include <cmath>

#include <opencv2/core/mat.hpp>

namespace roomgraph::test {

/// Bilinear value of an 8 bit picture; outside of it the border goes on.
inline unsigned char bilinear(const cv::Mat& image, double x, double y) {
  const int i = std::clamp(static_cast<int>(x), 0, image.cols - 2), j = std::clamp(static_cast<int>(y), 0, image.rows - 2);
  const double a = x - i, b = y - j;
  const auto at = [&](int dy, int dx) { return static_cast<double>(image.at<unsigned char>(j + dy, i + dx)); };
  const double value = (1 - b) * ((1 - a) * at(0, 0) + a * at(0, 1)) + b * ((1 - a) * at(1, 0) + a * at(1, 1));
  return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace roomgraph::test
