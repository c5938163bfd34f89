// SPDX-License-Identifier: BSD-3-Clause
// The parameters of a calibration as one vector: names, units, and what counts as known.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace roomgraph {

/// Places in the vector of parameters. Poses are robot_from_sensor, of the camera with x forward (MRPT's
/// axes, at the optical centre of the colour camera): m, rad. Time offsets are added to stamps, s; that of
/// the lidar (of the wheels where there is no lidar) is zero.
enum ParameterIndex {
  kLidarX,
  kLidarY,
  kLidarYaw,
  kCameraX,
  kCameraY,
  kCameraZ,
  kCameraYaw,
  kCameraPitch,
  kCameraRoll,
  kCameraTime,
  kWheelTime,
  kWheelScale,
  kTurnScale,
  kHeadingDrift,
  kDepthScale,
  kDepthBias,
  kParameterCount
};

using ParameterVector = Eigen::Matrix<double, kParameterCount, 1>;
using ParameterMatrix = Eigen::Matrix<double, kParameterCount, kParameterCount>;

struct ParameterTraits {
  const char* name;
  const char* unit;
  /// Standard deviation from which on a parameter counts as unknown, in the vector's units.
  double unknown_from;
  /// Standard deviation of what the model leaves out and does not scatter, in the vector's units: a floor that is not quite
  /// even, depth that comes in steps, wheels that slip once or twice.
  double model_error;
};

/// By ParameterIndex.
const std::array<ParameterTraits, kParameterCount>& parameterTraits();

}  // namespace roomgraph
