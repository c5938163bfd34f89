// SPDX-License-Identifier: BSD-3-Clause
// Calibration of camera, lidar and wheels from recordings of ordinary driving.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/calibration/board.h"
#include "roomgraph/calibration/estimate.h"
#include "roomgraph/datasets/calibration_file.h"
#include "roomgraph/datasets/rawlog_reader.h"

namespace roomgraph {

/// Sensors of the recordings, as they were recorded.
struct SensorsBefore {
  std::string camera_label, lidar_label;
  std::optional<Pose3> robot_from_lidar,
      robot_from_camera;                       ///< the latter of the colour camera, optical axes
  Pose3 robot_from_depth = Pose3::Identity();  ///< MRPT's sensorPose of the camera's records, x forward
  bool depth = false, wheels = false;        ///< whether there is any
  bool board = false, board_depth = false;  ///< whether an image shows the board, and depth on it
};

struct CalibrationReport {
  SensorsBefore sensors;
  CalibrationEstimate estimate;
  Calibration calibration;  ///< to be applied to the recordings: what the estimate changes, and former poses
  std::string frame;        ///< in words, what the robot's frame and the clock are taken from
};

/// What is being done, and the share of it that is done.
using CalibrationProgress = std::function<void(const std::string& what, double share)>;

/// Reads the recordings, which must be of the same sensors in the same places. `read`: chosen sensors, and
/// poses to begin with. `board`: a chessboard to look for, which stands still in each recording. Throws InputError or
/// ConfigError like RawlogReader, InputError when a recording has other sensors, moves them on the robot, or when none shows
/// the board, RunError when nothing in the recordings says anything. `progress` may throw to end it.
CalibrationReport calibrate(const std::vector<std::filesystem::path>& recordings, const ReadOptions& read,
                            const std::optional<Board>& board = std::nullopt,
                            const CalibrationProgress& progress = nullptr);

/// The calibration as the INI file that readCalibration() takes, with standard deviations in comments.
std::string calibrationText(const CalibrationReport& report);

}  // namespace roomgraph
