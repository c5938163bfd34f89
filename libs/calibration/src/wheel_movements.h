// SPDX-License-Identifier: BSD-3-Clause
// Movements of the robot by its wheels, and the same by the lidar.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sensor_model.h"

namespace roomgraph {

/// Movement of the robot by its wheels from one reading over others to a last one, beside that of the lidar.
/// The times are those of readings: of movements with independent errors, those in between would share some.
struct WheelMovement {
  const PlanarPath* lidar = nullptr;
  double t_a = 0, t_b = 0;                 ///< stamps of the wheels
  std::vector<PlanarValues<double>> read;  ///< from reading to reading
  // By the lidar, at the time offset for which the movement was made:
  PlanarValues<double> moved{};      ///< the lidar, from first to last reading
  std::vector<double> headings_rad;  ///< at the beginning of each of `read`, against the first
  double length_m = 0, turn_rad = 0;
  /// Sum of length times direction times its transpose: how an error of lengths spreads over the plane, in
  /// the robot's frame at the first reading.
  Eigen::Matrix2d directions = Eigen::Matrix2d::Zero();

  /// Place by the lidar minus place by the wheels, in the robot's frame at the first reading. The wheels say
  /// how far, the lidar in which direction: errors of turns by wheels would lead far from the place.
  template <class T>
  Eigen::Matrix<T, 2, 1> placeDifference(const T* p) const {
    using std::cos;
    using std::sin;
    const PlanarValues<T> robot = robotMovement(p, PlanarValues<T>{T(moved[0]), T(moved[1]), T(moved[2])});
    Eigen::Matrix<T, 2, 1> out(robot[0], robot[1]);
    for (std::size_t i = 0; i < read.size(); ++i) {
      const auto step = correctedMovement(p, PlanarValues<T>{T(read[i][0]), T(read[i][1]), T(read[i][2])});
      const double c = cos(headings_rad[i]), s = sin(headings_rad[i]);
      out.x() -= c * step[0] - s * step[1];
      out.y() -= s * step[0] + c * step[1];
    }
    return out;
  }

  /// Turn by the lidar minus turn by the wheels. `offset_s` is added to the stamps of the wheels.
  template <class T>
  T turnDifference(const T* p, const T& offset_s) const {
    T out = lidar->at(T(t_b + offset_s))[2] - lidar->at(T(t_a + offset_s))[2];
    for (const auto& step : read)
      out -= correctedMovement(p, PlanarValues<T>{T(step[0]), T(step[1]), T(step[2])})[2];
    return out;
  }
};

/// Movements of about `seconds` each, one behind the other, at the parameters' time offset and place of the
/// lidar. Without those that are not seen by the lidar, and without standing still.
std::vector<WheelMovement> wheelMovements(const std::vector<PlanarPath>& lidar, const PlanarPath& wheels,
                                          const ParameterVector& parameters, double seconds);

}  // namespace roomgraph
