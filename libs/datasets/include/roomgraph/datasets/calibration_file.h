// SPDX-License-Identifier: BSD-3-Clause
// Calibration file: what takes the place of sensor poses, stamps, wheel odometry and depths of a recording.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>

#include "roomgraph/datasets/sensor_poses.h"

namespace roomgraph {

/// Correction of wheel odometry. Of a movement along an arc of length s (m) and angle a (rad), the length
/// becomes scale * s and the angle turn_scale * a + drift_rad_m * scale * s.
struct WheelCorrection {
  double scale = 1, turn_scale = 1;
  double drift_rad_m = 0;  ///< wheels of unequal size
  bool operator==(const WheelCorrection&) const = default;
};

/// Correction of depth along the optical axis: z becomes scale * z + bias_m.
struct DepthCorrection {
  double scale = 1, bias_m = 0;
  bool operator==(const DepthCorrection&) const = default;
};

/// What is changed in the records of a recording, besides sensor poses.
struct RecordCorrections {
  std::map<std::string, double> time_offsets_s;  ///< by sensor label; added to the stamps
  double wheels_time_offset_s = 0;               ///< of whatever gives odometry
  WheelCorrection wheels;
  DepthCorrection depth;  ///< of the camera that is used
  /// By sensor label, added to the stamps once they have jumped by about minus this, in the order of the file, against those of the
  /// other sensors, until they jump back.
  std::map<std::string, double> time_jumps_s = {};
  double wheels_time_jump_s = 0;  ///< the same, of whatever gives odometry
  /// By sensor label: by what its recorded pose on the robot is turned, about the sensor's own place and along the robot's axes.
  std::map<std::string, Eigen::Quaterniond> turns = {};
  bool operator==(const RecordCorrections&) const = default;
};

/// What a calibration file says. Labels that it does not name keep what was recorded.
struct Calibration {
  SensorPoses poses;
  RecordCorrections corrections;
};

/// Reads an INI file with sections [sensor LABEL] (pose = x,y,z,yaw,pitch,roll in m and deg; time_offset_s),
/// [wheels] (scale, turn_scale, drift_rad_m, time_offset_s) and [depth] (scale, bias_m), all optional. Throws
/// InputError when it cannot be read, ConfigError with file and line for an unknown section or key and for a
/// value out of range.
Calibration readCalibration(const std::filesystem::path& file);

/// A movement of the robot by wheel odometry, corrected.
Pose2 corrected(const Pose2& movement, const WheelCorrection& correction);

}  // namespace roomgraph
