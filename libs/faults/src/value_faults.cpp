// SPDX-License-Identifier: BSD-3-Clause
// NaN, infinity and normal noise in ranges, depths, pictures and odometry poses.
#include "value_faults.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/mat.hpp>

namespace roomgraph {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;

constexpr double kStruckBeams = 0.2;
constexpr double kRangeSigma_m = 0.3, kDepthSigma_m = 0.1, kGreySigma = 40, kPoseSigma = 0.1;  // m, rad

void addNoise(CObservation2DRangeScan& scan, double factor, Random& random) {
  constexpr float kNearest_m = 0.01f;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    if (!scan.getScanRangeValidity(i)) continue;
    const float range = scan.getScanRange(i) + static_cast<float>(random.normal(0, factor * kRangeSigma_m));
    const float farthest = scan.maxRange > 0 ? scan.maxRange : std::numeric_limits<float>::max();
    scan.setScanRange(i, std::clamp(range, kNearest_m, farthest));
  }
}

void addNoise(mrpt::img::CImage& image, double factor, Random& random) {
  cv::Mat pixels = image.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
  const int values = pixels.cols * pixels.channels();
  for (int v = 0; v < pixels.rows; ++v)
    for (int i = 0; i < values; ++i) {
      auto& value = pixels.ptr<std::uint8_t>(v)[i];
      value = cv::saturate_cast<std::uint8_t>(value + random.normal(0, factor * kGreySigma));
    }
  image = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
}

void addNoise(CObservation3DRangeScan& images, double factor, Random& random) {
  if (images.hasRangeImage && images.rangeUnits > 0)
    for (auto& depth : images.rangeImage) {
      if (depth == 0) continue;
      const double noise = random.normal(0, factor * kDepthSigma_m) / images.rangeUnits;
      depth = static_cast<std::uint16_t>(std::clamp(depth + std::round(noise), 1.0, 65535.0));
    }
  if (images.hasIntensityImage && !images.intensityImage.isEmpty())
    addNoise(images.intensityImage, factor, random);
}

void addNoise(CObservationOdometry& reading, double factor, Random& random) {
  const double sigma = factor * kPoseSigma;
  const double x = reading.odometry.x() + random.normal(0, sigma);
  const double y = reading.odometry.y() + random.normal(0, sigma);
  reading.odometry = {x, y, reading.odometry.phi() + random.normal(0, sigma)};
  reading.hasEncodersInfo = false;
}

}  // namespace

float NotANumberFault::nextValue() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity};
  return values[struck_++ % 3];
}

bool NotANumberFault::strike(mrpt::obs::CObservation& observation) {
  if (auto* scan = dynamic_cast<CObservation2DRangeScan*>(&observation)) {
    bool any = false;
    for (std::size_t i = 0; i < scan->getScanSize(); ++i) {
      if (!random_.chance(kStruckBeams)) continue;
      scan->setScanRange(i, nextValue());
      scan->setScanRangeValidity(i, true);
      any = true;
    }
    return any;
  }
  if (auto* reading = dynamic_cast<CObservationOdometry*>(&observation)) {
    const int coordinate = struck_ % 3;
    const double value = static_cast<double>(nextValue());
    auto& pose = reading->odometry;
    if (coordinate == 0) pose.x(value);
    if (coordinate == 1) pose.y(value);
    if (coordinate == 2) pose.phi(value);
    return true;
  }
  auto* images = dynamic_cast<CObservation3DRangeScan*>(&observation);
  if (!images || !images->hasRangeImage) return false;
  images->rangeUnits = nextValue();
  return true;
}

PassingRecords NotANumberFault::pass(PassingRecord record) {
  if (sensors_.contains(record.sensor) && window_.contains(record.t) && strike(*record.observation))
    changed(record);
  return one(std::move(record));
}

bool NoiseFault::strike(mrpt::obs::CObservation& observation) {
  if (auto* scan = dynamic_cast<CObservation2DRangeScan*>(&observation))
    addNoise(*scan, factor_, random_);
  else if (auto* images = dynamic_cast<CObservation3DRangeScan*>(&observation))
    addNoise(*images, factor_, random_);
  else if (auto* reading = dynamic_cast<CObservationOdometry*>(&observation))
    addNoise(*reading, factor_, random_);
  else
    return false;
  return true;
}

PassingRecords NoiseFault::pass(PassingRecord record) {
  if (sensors_.contains(record.sensor) && window_.contains(record.t) && strike(*record.observation))
    changed(record);
  return one(std::move(record));
}

}  // namespace roomgraph
