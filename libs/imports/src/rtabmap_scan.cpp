// SPDX-License-Identifier: BSD-3-Clause
// 2D scans of RTAB-Map: points, compressed by zlib, into the beams of a scan.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "rtabmap_blobs.h"

namespace roomgraph::rtabmap {
namespace {

constexpr double kFullCircle = 2 * std::numbers::pi;

struct ScanInfo {
  int format = 0;
  double max_range_m = 0;                         ///< 0: not known
  double angle_min = 0, angle_max = 0, step = 0;  ///< rad; step 0: not known
  Pose3 robot_from_scanner = Pose3::Identity();
};

// From 0.18 on: format, least and largest range, angles, most points, transform; before: most points, largest
// range, perhaps the format, transform. All floats.
Outcome<ScanInfo> infoOf(Blob blob, const Version& version) {
  const bool angles = version >= Version{0, 18, 0};
  const std::size_t numbers = blob.size() / sizeof(float), head = angles ? 7 : numbers - 12;
  if (blob.size() % sizeof(float) != 0 || numbers < 14 || numbers != head + 12 ||
      (!angles && head != 2 && head != 3))
    return Outcome<ScanInfo>::failure("scan_info has an impossible size");
  std::vector<float> values(numbers);
  std::memcpy(values.data(), blob.data(), blob.size());
  const auto place = transformOf(blob.subspan(head * sizeof(float)));
  if (!place) return Outcome<ScanInfo>::failure("the scanner's place is no transform");
  ScanInfo info;
  info.robot_from_scanner = *place;
  const auto number = [&](std::size_t i) {
    return std::isfinite(values[i]) ? static_cast<double>(values[i]) : 0;
  };
  if (!angles) {
    info.max_range_m = number(1);
    info.format = head == 3 ? static_cast<int>(number(2)) : 0;
    return info;
  }
  info.format = static_cast<int>(std::clamp(number(0), 0., 100.));
  info.max_range_m = number(2);
  if (number(4) > number(3) && number(5) > 0 && number(4) - number(3) < kFullCircle + number(5)) {
    info.angle_min = number(3);
    info.angle_max = number(4);
    info.step = number(5);
  }
  return info;
}

struct Points {
  std::size_t channels = 0;
  std::vector<float> values;  ///< channels of each point in turn
};

// zlib's stream, then rows, columns and type of a matrix of OpenCV.
Outcome<Points> pointsOf(Blob blob) {
  constexpr std::size_t kTail = 3 * sizeof(std::int32_t), kMostRatio = 1100;  // zlib's is 1032
  std::array<std::int32_t, 3> shape{};
  if (blob.size() <= kTail) return Outcome<Points>::failure("scan is cut off");
  const Blob packed = blob.first(blob.size() - kTail);
  std::memcpy(shape.data(), blob.last(kTail).data(), kTail);
  const auto [rows, cols, type] = shape;
  const auto channels = static_cast<std::size_t>(CV_MAT_CN(type));
  if (rows < 1 || cols < 1 || CV_MAT_DEPTH(type) != CV_32F)
    return Outcome<Points>::failure("scan is damaged or of an unknown type");
  const std::uint64_t count = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(cols) * channels;
  if (count * sizeof(float) > packed.size() * kMostRatio) return Outcome<Points>::failure("scan is damaged");
  Points points{channels, std::vector<float>(count)};
  uLongf size = count * sizeof(float);
  if (uncompress(reinterpret_cast<Bytef*>(points.values.data()), &size, packed.data(), packed.size()) !=
          Z_OK ||
      size != count * sizeof(float))
    return Outcome<Points>::failure("scan is damaged");
  return points;
}

// Of a 2D scan: XY, XYI, XYNormal, XYINormal; old databases do not say.
bool is2d(int format, std::size_t channels) {
  constexpr std::array<std::size_t, 5> kChannels{2, 2, 3, 5, 6};
  return format >= 0 && static_cast<std::size_t>(format) < kChannels.size() &&
         channels == kChannels[static_cast<std::size_t>(format)];
}

mrpt::obs::CObservation2DRangeScan::Ptr scanOfPoints(const Points& points, ScanInfo info) {
  constexpr int kBeams = 720;
  if (info.step <= 0) {
    info.step = kFullCircle / kBeams;
    info.angle_min = 0.5 * info.step - std::numbers::pi;
    info.angle_max = info.angle_min + (kBeams - 1) * info.step;
  }
  const auto beams = static_cast<std::size_t>(std::lround((info.angle_max - info.angle_min) / info.step)) + 1;
  std::vector<float> nearest(beams, 0);
  float farthest = 0;
  for (std::size_t i = 0; i + 1 < points.values.size(); i += points.channels) {
    const float x = points.values[i], y = points.values[i + 1], range = std::hypot(x, y);
    if (!std::isfinite(range) || range <= 0) continue;
    double angle = std::atan2(static_cast<double>(y), static_cast<double>(x));
    const double middle = 0.5 * (info.angle_min + info.angle_max);
    angle += kFullCircle * std::round((middle - angle) / kFullCircle);
    const auto beam = std::lround((angle - info.angle_min) / info.step);
    if (beam < 0 || static_cast<std::size_t>(beam) >= beams) continue;
    float& kept = nearest[static_cast<std::size_t>(beam)];
    kept = kept > 0 ? std::min(kept, range) : range;
    farthest = std::max(farthest, range);
  }
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  const double span = static_cast<double>(beams - 1) * info.step;
  scan->aperture = static_cast<float>(std::min(span, kFullCircle));
  scan->rightToLeft = true;
  const auto largest = static_cast<float>(info.max_range_m);
  scan->maxRange = largest > 0 ? largest : farthest;
  scan->resizeScan(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    scan->setScanRange(i, nearest[i]);
    scan->setScanRangeValidity(i, nearest[i] > 0 && (largest <= 0 || nearest[i] < largest));
  }
  scan->sensorPose = toMrpt(info.robot_from_scanner * toPose3(Pose2{0, 0, info.angle_min + 0.5 * span}));
  return scan;
}

}  // namespace

Outcome<mrpt::obs::CObservation2DRangeScan::Ptr> scanOf(Blob scan, Blob info, const Version& version) {
  using Failure = Outcome<mrpt::obs::CObservation2DRangeScan::Ptr>;
  const auto about = infoOf(info, version);
  if (!about) return Failure::failure(about.reason());
  if (about->step > 0 && (about->angle_max - about->angle_min) / about->step > 1e5)
    return Failure::failure("scan_info has impossible angles");
  const auto points = pointsOf(scan);
  if (!points) return Failure::failure(points.reason());
  if (!is2d(about->format, points->channels)) return Failure::failure("is no 2D scan");
  return scanOfPoints(*points, *about);
}

}  // namespace roomgraph::rtabmap
