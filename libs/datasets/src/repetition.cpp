// SPDX-License-Identifier: BSD-3-Clause
// Comparison of neighbouring records by a hash of their content.
#include "repetition.h"

#include <cmath>
#include <functional>

namespace roomgraph {

void Repetition::add(double t, std::string_view content) {
  const std::size_t hash = std::hash<std::string_view>()(content);
  if (current_.records == 0 || hash != hash_) current_ = {0, t, 0};
  hash_ = hash;
  ++current_.records;
  current_.seconds = t - current_.from;
  if (longest_.records == 0 || current_.seconds > longest_.seconds) longest_ = current_;
}

bool HangingSensor::hangs(double t, std::string_view content, const std::optional<Pose2>& wheels) {
  constexpr int kFew = 5, kMany = 20;
  constexpr double kMoved_m = 0.02, kTurned_rad = 0.02;
  same_.add(t, content);
  const SameRecords& run = same_.current();
  if (run.records < 2) {
    wheels_before_ = wheels;
    ++changes_;
  }
  if (run.records < (changes_ > kFew ? 2 : kFew) || run.seconds <= 0) return false;
  if (!wheels) return changes_ > kMany;
  if (!wheels_before_) return false;
  return std::hypot(wheels->x - wheels_before_->x, wheels->y - wheels_before_->y) > kMoved_m ||
         std::abs(wrapAngle(wheels->yaw - wheels_before_->yaw)) > kTurned_rad;
}

std::string samplesOf(const cv::Mat& image) {
  constexpr int kStride = 7;
  std::string samples;
  for (int v = 0; v < image.rows; v += kStride)
    for (int u = 0; u < image.cols; u += kStride)
      samples.append(image.ptr<char>(v) + static_cast<std::size_t>(u) * image.elemSize(), image.elemSize());
  return samples;
}

bool hasReturn(const mrpt::obs::CObservation2DRangeScan& scan) {
  for (std::size_t i = 0; i < scan.getScanSize(); ++i)
    if (scan.getScanRangeValidity(i)) return true;
  return false;
}

std::string contentOf(const mrpt::obs::CObservation2DRangeScan& scan) {
  std::string content;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const float range = scan.getScanRange(i);
    content.append(reinterpret_cast<const char*>(&range), sizeof range);
    content.push_back(scan.getScanRangeValidity(i) ? 1 : 0);
  }
  return content;
}

std::string contentOf(const mrpt::obs::CObservation3DRangeScan& images) {
  std::string content;
  if (images.hasIntensityImage && !images.intensityImage.isEmpty())
    content = samplesOf(images.intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY));
  if (!images.hasRangeImage || images.rangeImage.size() == 0) return content;
  mrpt::math::CMatrix_u16 depth = images.rangeImage;
  const cv::Mat pixels(static_cast<int>(depth.rows()), static_cast<int>(depth.cols()), CV_16UC1,
                       depth.data());
  return content + samplesOf(pixels);
}

}  // namespace roomgraph
