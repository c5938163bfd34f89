// SPDX-License-Identifier: BSD-3-Clause
// Planar lidar scan and wheel odometry reading.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <string>
#include <vector>

#include "roomgraph/geometry/pose.h"

namespace roomgraph {

/// One planar laser scan, taken at one instant.
struct Scan {
  double t = 0;                 ///< s
  std::vector<float> ranges_m;  ///< beam i points at angle_min_rad + i * angle_step_rad
  std::vector<char> valid;      ///< 1: a return; 0: nothing within range, or a dropout
  double angle_min_rad = 0, angle_step_rad = 0;
  double max_range_m = 0;
  Pose3 robot_from_lidar = Pose3::Identity();
  std::string sensor_label;

  /// Valid returns as points in the robot frame (z = height of the return).
  std::vector<Eigen::Vector3d> pointsInRobot() const;
};

Scan toScan(const mrpt::obs::CObservation2DRangeScan& observation);
/// For MRPT's own maps and viewers.
mrpt::obs::CObservation2DRangeScan::Ptr toMrpt(const Scan& scan);

/// One wheel odometry reading: pose in the drifting odometry frame, or an increment already summed up by the
/// reader.
struct OdometryReading {
  double t = 0;
  Pose2 odom_from_robot;
};

}  // namespace roomgraph
