// SPDX-License-Identifier: BSD-3-Clause
// Rays against the box, for each beam and pixel.
#include "moving_furniture.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <utility>

namespace roomgraph {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;

constexpr double kClear_m = 0.7;    // between the middles of robot and box: whoever pushes it keeps it away
constexpr double kPattern_m = 0.08;  // squares of one grey
constexpr double kNewest_s = 0.5;    // the velocity of older readings is not gone on with

double towardsEnd(double t, double low, double high) {
  const double span = high - low, at = std::fmod(t, 2 * span);
  return low + (at < span ? at : 2 * span - at);
}

// A grey for each square of the surface, always the same.
std::uint8_t greyAt(const Eigen::Vector3d& point) {
  std::uint32_t hash = 17;
  for (const double x : {point.x(), point.y(), point.z()})
    hash = (hash ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(x / kPattern_m + 1e-3)))) * 2654435761U;
  return static_cast<std::uint8_t>(40 + (hash >> 24) % 170);
}

bool draw(CObservation2DRangeScan& scan, const Pose3& box_from_robot) {
  const Pose3 box_from_lidar = box_from_robot * toPose3(scan.sensorPose);
  const auto beams = static_cast<double>(scan.getScanSize());
  const double step = beams > 1 ? scan.aperture / (beams - 1) : 0;
  bool any = false;
  for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
    const double from_first = static_cast<double>(i) * step - scan.aperture / 2, angle = scan.rightToLeft ? from_first : -from_first;
    const auto enters = entersBox(box_from_lidar.translation(), box_from_lidar.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    if (!enters || (scan.maxRange > 0 && *enters > scan.maxRange)) continue;
    if (scan.getScanRangeValidity(i) && scan.getScanRange(i) <= static_cast<float>(*enters)) continue;
    scan.setScanRange(i, static_cast<float>(*enters));
    scan.setScanRangeValidity(i, true);
    any = true;
  }
  return any;
}

struct Hit {
  double depth_m;
  std::uint8_t grey;
};

// What a pixel's ray meets of the box; `box_from_optical` has z along the axis of the camera.
std::optional<Hit> hitOf(const Pose3& box_from_optical, const mrpt::img::TCamera& camera, double u, double v) {
  const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(), 1);
  const Eigen::Vector3d direction = box_from_optical.linear() * ray;
  const auto enters = entersBox(box_from_optical.translation(), direction);
  if (!enters) return std::nullopt;
  return Hit{*enters, greyAt(box_from_optical.translation() + *enters * direction)};
}

// Which pixels of the depth image the box hides, 255, and these pixels set to it.
cv::Mat drawDepth(CObservation3DRangeScan& images, const Pose3& box_from_optical) {
  auto& ranges = images.rangeImage;
  cv::Mat hidden(static_cast<int>(ranges.rows()), static_cast<int>(ranges.cols()), CV_8UC1, cv::Scalar(0));
  const auto& camera = images.cameraParams;
  for (int v = 0; v < hidden.rows; ++v)
    for (int u = 0; u < hidden.cols; ++u) {
      const auto hit = hitOf(box_from_optical, camera, u, v);
      if (!hit) continue;
      const double slant = images.range_is_depth ? 1 : std::hypot((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(), 1);
      const double units = std::round(hit->depth_m * slant / images.rangeUnits);
      auto& range = ranges(v, u);
      if (units > std::numeric_limits<std::uint16_t>::max() || (range != 0 && range <= units)) continue;
      range = static_cast<std::uint16_t>(units);
      hidden.at<std::uint8_t>(v, u) = 255;
    }
  return hidden;
}

// Pictures with as many pixels or others than the depth image: what it hides is looked up at the same share of width and height.
bool drawPicture(CObservation3DRangeScan& images, const Pose3& box_from_optical, const cv::Mat& hidden) {
  cv::Mat pixels = images.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
  bool any = false;
  for (int v = 0; v < pixels.rows; ++v)
    for (int u = 0; u < pixels.cols; ++u) {
      const auto hit = hitOf(box_from_optical, images.cameraParamsIntensity, u, v);
      if (!hit || (!hidden.empty() && !hidden.at<std::uint8_t>(v * hidden.rows / pixels.rows, u * hidden.cols / pixels.cols))) continue;
      std::fill_n(pixels.ptr<std::uint8_t>(v) + u * pixels.channels(), pixels.channels(), hit->grey);
      any = true;
    }
  if (any) images.intensityImage = mrpt::img::CImage(pixels, mrpt::img::SHALLOW_COPY);
  return any;
}

bool draw(CObservation3DRangeScan& images, const Pose3& box_from_robot) {
  const Pose3 box_from_sensor = box_from_robot * toPose3(images.sensorPose);
  Pose3 forward_from_optical = Pose3::Identity();
  forward_from_optical.linear() = bodyFromOptical();
  cv::Mat hidden;
  if (images.hasRangeImage && images.rangeImage.size() > 0 && images.rangeUnits > 0)
    hidden = drawDepth(images, box_from_sensor * forward_from_optical);
  bool any = !hidden.empty() && cv::countNonZero(hidden) > 0;
  if (images.hasIntensityImage && !images.intensityImage.isEmpty())
    any |= drawPicture(images, box_from_sensor * toPose3(images.relativePoseIntensityWRTDepth), hidden);
  if (any) {  // those of the room as it was
    images.hasPoints3D = false;
    images.resizePoints3DVectors(0);
  }
  return any;
}

}  // namespace

Pose3 MovingBox::odom_from_box(double seconds) const {
  const double aside = towardsEnd(speed_m_s * seconds, -kAside_m, kAside_m);
  return toPose3(planarPart(odom_from_robot)) * Eigen::Translation3d(kAhead_m, -aside, 0);
}

std::optional<double> entersBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low(-MovingBox::kDepth_m / 2, -MovingBox::kWidth_m / 2, 0), high(-low.x(), -low.y(), MovingBox::kHeight_m);
  double first = -std::numeric_limits<double>::infinity(), last = -first;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < low[i] || origin[i] > high[i]) return std::nullopt;
      continue;
    }
    const double a = (low[i] - origin[i]) / direction[i], b = (high[i] - origin[i]) / direction[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first <= 0 || first > last) return std::nullopt;
  return first;
}

void MovingFurnitureFault::remember(const PassingRecord& record) {
  const auto& pose = dynamic_cast<const mrpt::obs::CObservationOdometry&>(*record.observation).odometry;
  const Pose2 odom_from_robot{pose.x(), pose.y(), pose.phi()};
  if (!std::isfinite(odom_from_robot.x) || !std::isfinite(odom_from_robot.y) || !std::isfinite(odom_from_robot.yaw)) return;
  if (!last_) label_ = record.label();
  if (record.label() != label_) return;
  before_ = last_ && record.t > last_->t ? last_ : std::nullopt;
  last_ = Reading{record.t, odom_from_robot};
}

// Wheels tell of other times than images.
Pose3 MovingFurnitureFault::robotAt(double t) const {
  const Pose3 last = toPose3(last_->odom_from_robot);
  if (!before_ || t - last_->t > kNewest_s) return last;
  return interpolate(toPose3(before_->odom_from_robot), last, (t - before_->t) / (last_->t - before_->t));
}

PassingRecords MovingFurnitureFault::pass(PassingRecord record) {
  if (record.sensor == FaultySensor::kOdometry) {
    remember(record);
    return one(std::move(record));
  }
  if (!last_ || !window_.contains(record.t)) return one(std::move(record));
  const Pose3 odom_from_robot = robotAt(record.t);
  if (!std::exchange(begun_, true)) box_.odom_from_robot = odom_from_robot;
  const Pose3 box_from_robot = box_.odom_from_box(record.t - window_.from_s).inverse() * odom_from_robot;
  if (box_from_robot.translation().norm() < kClear_m) return one(std::move(record));
  auto* scan = dynamic_cast<CObservation2DRangeScan*>(record.observation.get());
  auto* images = dynamic_cast<CObservation3DRangeScan*>(record.observation.get());
  if ((scan && draw(*scan, box_from_robot)) || (images && draw(*images, box_from_robot))) changed(record);
  return one(std::move(record));
}

}  // namespace roomgraph
