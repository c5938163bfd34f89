// SPDX-License-Identifier: BSD-3-Clause
// Conversion of scans from and to MRPT, and returns as points.
#include "roomgraph/observations/scan.h"

#include <mrpt/core/Clock.h>

#include <cmath>

namespace roomgraph {

std::vector<Eigen::Vector3d> Scan::pointsInRobot() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (!valid[i]) continue;
    const double angle = angle_min_rad + static_cast<double>(i) * angle_step_rad;
    points.push_back(robot_from_lidar *
                     Eigen::Vector3d(ranges_m[i] * std::cos(angle), ranges_m[i] * std::sin(angle), 0));
  }
  return points;
}

Scan toScan(const mrpt::obs::CObservation2DRangeScan& observation) {
  Scan scan;
  scan.t = mrpt::Clock::toDouble(observation.timestamp);
  scan.sensor_label = observation.sensorLabel;
  scan.max_range_m = observation.maxRange;
  scan.robot_from_lidar = toPose3(observation.sensorPose);
  const std::size_t count = observation.getScanSize();
  const double step = count > 1 ? observation.aperture / static_cast<double>(count - 1) : 0;
  scan.angle_min_rad = (observation.rightToLeft ? -0.5 : 0.5) * observation.aperture;
  scan.angle_step_rad = observation.rightToLeft ? step : -step;
  scan.ranges_m.resize(count);
  scan.valid.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = observation.getScanRange(i);
    const bool usable = observation.getScanRangeValidity(i) && std::isfinite(range) && range > 0;
    scan.ranges_m[i] = std::isfinite(range) ? range : 0.f;
    scan.valid[i] = usable && (observation.maxRange <= 0 || range < 0.999f * observation.maxRange);
  }
  return scan;
}

mrpt::obs::CObservation2DRangeScan::Ptr toMrpt(const Scan& scan) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  observation->timestamp = mrpt::Clock::fromDouble(scan.t);
  observation->sensorLabel = scan.sensor_label;
  observation->maxRange = static_cast<float>(scan.max_range_m);
  observation->sensorPose = toMrpt(scan.robot_from_lidar);
  observation->rightToLeft = scan.angle_step_rad >= 0;
  observation->aperture =
      static_cast<float>(std::abs(scan.angle_step_rad) *
                         static_cast<double>(scan.ranges_m.empty() ? 0 : scan.ranges_m.size() - 1));
  observation->resizeScan(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    observation->setScanRange(i, scan.ranges_m[i]);
    observation->setScanRangeValidity(i, scan.valid[i] != 0);
  }
  return observation;
}

}  // namespace roomgraph
