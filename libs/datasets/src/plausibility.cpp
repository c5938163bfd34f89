// SPDX-License-Identifier: BSD-3-Clause
// Limits on scans, camera intrinsics, images, masks and detections.
#include "plausibility.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "odometry_sum.h"
#include "roomgraph/observations/CObservationDetections.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;

constexpr double kEndOfTime_s = 7258118400;               // 2200-01-01
constexpr double kLargestAperture_rad = 2 * M_PI + 0.01;  // a full circle, rounded
constexpr double kLargestCoordinate_px = 1e6;
constexpr double kLargestDistortion = 1e4;
constexpr double kLargestRangeUnit_m = 1;
constexpr std::uint32_t kLargestSide_px = 1u << 15;

std::string about(const char* what, const std::string& problem) {
  return problem.empty() ? "" : what + problem.substr(std::string("pose").size());
}

std::string problemOfScan(const CObservation2DRangeScan& scan) {
  if (const auto problem = problemOf(toPose3(scan.sensorPose)); !problem.empty())
    return about("sensor pose", problem);
  const double aperture = static_cast<double>(scan.aperture);
  if (!std::isfinite(scan.maxRange)) return "maximum range is not finite";
  if (std::isfinite(aperture) && aperture >= 0 && aperture <= kLargestAperture_rad &&
      (aperture > 0 || scan.getScanSize() <= 1))
    return "";
  char text[100];
  std::snprintf(text, sizeof text,
                "aperture of %.4g rad is impossible (it is in radians, first beam to last)", aperture);
  return text;
}

std::string problemOfCamera(const mrpt::img::TCamera& camera) {
  if (camera.ncols > kLargestSide_px || camera.nrows > kLargestSide_px) return "camera's image is too large";
  const auto within = [](double value, double limit) { return std::abs(value) < limit; };
  for (const double value : {camera.fx(), camera.fy(), camera.cx(), camera.cy()})
    if (!within(value, kLargestCoordinate_px)) return "camera intrinsics are not finite or too large";
  for (const double value : camera.dist)
    if (!within(value, kLargestDistortion)) return "lens distortion is not finite or too large";
  return "";
}

std::string problemOfImages(const CObservation3DRangeScan& images) {
  if (const auto problem = problemOf(toPose3(images.sensorPose)); !problem.empty())
    return about("sensor pose", problem);
  if (images.hasRangeImage) {
    if (!(images.rangeUnits > 0) || images.rangeUnits > kLargestRangeUnit_m)
      return "rangeUnits is not in (0, 1] m";
    if (const auto problem = problemOfCamera(images.cameraParams); !problem.empty())
      return "depth " + problem;
  }
  if (!images.hasIntensityImage) return "";
  if (const auto problem = problemOf(toPose3(images.relativePoseIntensityWRTDepth)); !problem.empty())
    return about("pose of the colour camera", problem);
  const auto problem = problemOfCamera(images.cameraParamsIntensity);
  return problem.empty() ? "" : "colour " + problem;
}

std::string problemOfMask(const MaskRuns& mask) {
  if (mask.runs.empty()) return "";
  if (mask.width > kLargestSide_px || mask.height > kLargestSide_px) return "mask is too large";
  const auto pixels = std::accumulate(mask.runs.begin(), mask.runs.end(), std::uint64_t{0});
  return pixels == std::uint64_t{mask.width} * mask.height ? "" : "mask's runs do not fill it";
}

std::string problemOfDetections(const CObservationDetections& detections) {
  if (!std::isfinite(detections.score_threshold) || !std::isfinite(detections.nms_threshold))
    return "a threshold is not finite";
  for (const auto& item : detections.items) {
    if (!(item.score >= 0 && item.score <= 1)) return "score of a box is not in [0, 1]";
    for (const double side : {item.u_min, item.v_min, item.u_max, item.v_max})
      if (!(std::abs(side) < kLargestCoordinate_px)) return "a box is not finite or too large";
    if (auto problem = problemOfMask(item.mask); !problem.empty()) return problem;
  }
  return "";
}

}  // namespace

bool plausibleTime(double t) {
  return t >= 0 && t < kEndOfTime_s;
}

std::string problemOf(const mrpt::obs::CObservation& observation) {
  const auto t = toSeconds(observation.timestamp);
  if (t && !plausibleTime(*t)) return "time stamp is not between 1970 and 2200";
  if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation))
    return problemOfScan(*scan);
  if (const auto* images = dynamic_cast<const CObservation3DRangeScan*>(&observation))
    return problemOfImages(*images);
  if (const auto* wheels = dynamic_cast<const CObservationOdometry*>(&observation))
    return problemOf(Pose2{wheels->odometry.x(), wheels->odometry.y(), wheels->odometry.phi()});
  if (const auto* detections = dynamic_cast<const CObservationDetections*>(&observation))
    return problemOfDetections(*detections);
  return "";
}

}  // namespace roomgraph
