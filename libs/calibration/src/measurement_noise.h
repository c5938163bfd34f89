// SPDX-License-Identifier: BSD-3-Clause
// Nominal standard deviations of what a calibration measures, and factors on them.
#pragma once

#include <array>
#include <cmath>

namespace roomgraph {

/// Kinds of residuals whose scatter is estimated.
enum class NoiseKind {
  kWall,
  kFloor,
  kCameraTurn,
  kCameraMove,
  kWheelForward,
  kWheelSide,
  kWheelTurn,
  kBoardTurn,
  kBoardPlace,
  kBoardDepth
};
inline constexpr std::size_t kNoiseKinds = 10;
/// On nominal standard deviations.
using NoiseFactors = std::array<double, kNoiseKinds>;

/// Of a movement by wheels against scan matching, forward and sideways (m) and of the turn (rad): of the
/// latter a constant, of the former what grows like a random walk.
inline double forwardSigma(double length_m) {
  return std::hypot(0.003, 0.02 * std::sqrt(length_m));
}
inline double sideSigma(double length_m, double turn_rad) {
  return std::hypot(0.003, 0.015 * length_m * std::sqrt(turn_rad));
}
inline double turnSigma(double length_m, double turn_rad) {
  return std::hypot(0.0015, 0.03 * std::sqrt(turn_rad), 0.005 * std::sqrt(length_m));
}

/// Of the mean of depth over a patch at depth z, m.
inline double patchSigma(double z_m) {
  return 0.002 + 0.001 * z_m * z_m;
}

}  // namespace roomgraph
