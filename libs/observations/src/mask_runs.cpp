// SPDX-License-Identifier: BSD-3-Clause
// Conversion between masks and run lengths.
#include "roomgraph/observations/mask_runs.h"

#include <algorithm>
#include <opencv2/core.hpp>

namespace roomgraph {
namespace {

constexpr std::uint32_t kLargestSide_px = 1u << 15;
constexpr std::uint64_t kMostPixels = 1u << 26;  // few numbers may stand for any size

}  // namespace

MaskRuns toRuns(const cv::Mat& mask) {
  MaskRuns out;
  if (mask.empty()) return out;
  out.width = static_cast<std::uint32_t>(mask.cols);
  out.height = static_cast<std::uint32_t>(mask.rows);
  bool on = false;
  std::uint32_t length = 0;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x) {
      if ((mask.at<unsigned char>(y, x) != 0) != on) {
        out.runs.push_back(length);
        length = 0;
        on = !on;
      }
      ++length;
    }
  out.runs.push_back(length);
  return out;
}

cv::Mat toMask(const MaskRuns& runs) {
  if (runs.runs.empty() || runs.width > kLargestSide_px || runs.height > kLargestSide_px) return {};
  const std::uint64_t size = static_cast<std::uint64_t>(runs.width) * runs.height;
  std::uint64_t sum = 0;
  for (const auto run : runs.runs) sum += run;
  if (sum != size || size == 0 || size > kMostPixels) return {};
  cv::Mat mask(static_cast<int>(runs.height), static_cast<int>(runs.width), CV_8UC1);
  unsigned char* pixel = mask.data;
  unsigned char value = 0;
  for (const auto run : runs.runs) {
    std::fill(pixel, pixel + run, value);
    pixel += run;
    value = static_cast<unsigned char>(255 - value);
  }
  return mask;
}

}  // namespace roomgraph
