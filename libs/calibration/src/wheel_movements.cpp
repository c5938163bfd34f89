// SPDX-License-Identifier: BSD-3-Clause
// Readings of the wheels in turn, and where the lidar was at each.
#include "wheel_movements.h"

namespace roomgraph {
namespace {

constexpr double kWheelsPathMargin_s = 0.3;  // as much as times may move while solving
constexpr double kStandsStill = 0.02;        // m + rad

// Lengths and turns are those of the lidar: the weight of a movement must not depend on the error of the
// wheels in it, as those that measured too little would count more.
void setByLidar(const PlanarPath& wheels, std::size_t first, const ParameterVector& parameters,
                WheelMovement& out) {
  const double offset = parameters[kWheelTime];
  const auto start = out.lidar->at(out.t_a + offset);
  auto before = start;
  for (std::size_t i = 0; i < out.read.size(); ++i) {
    const auto now = out.lidar->at(wheels.time(first + i + 1) + offset);
    const auto step = robotMovement(parameters.data(), planarBetween(before, now));
    const double heading = before[2] - start[2], length = std::hypot(step[0], step[1]);
    const double along = heading + step[2] / 2;
    const Eigen::Vector2d direction(std::cos(along), std::sin(along));
    out.headings_rad.push_back(heading);
    out.length_m += length;
    out.turn_rad += std::abs(step[2]);
    out.directions += length * direction * direction.transpose();
    before = now;
  }
  out.moved = planarBetween(start, before);
}

}  // namespace

std::vector<WheelMovement> wheelMovements(const std::vector<PlanarPath>& lidar, const PlanarPath& wheels,
                                          const ParameterVector& parameters, double seconds) {
  const double offset = parameters[kWheelTime];
  std::vector<WheelMovement> out;
  std::size_t first = 0;
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    const double t_a = wheels.time(first), t_b = wheels.time(i);
    if (t_b - t_a < seconds) continue;
    WheelMovement now;
    now.lidar = pathAt(lidar, t_a + offset, kWheelsPathMargin_s);
    if (now.lidar && now.lidar->covers(t_b + offset, kWheelsPathMargin_s) && t_b - t_a < 2 * seconds) {
      now.t_a = t_a;
      now.t_b = t_b;
      for (std::size_t k = first; k < i; ++k)
        now.read.push_back(planarBetween(wheels.values(k), wheels.values(k + 1)));
      setByLidar(wheels, first, parameters, now);
      if (now.length_m + now.turn_rad > kStandsStill) out.push_back(std::move(now));
    }
    first = i;
  }
  return out;
}

}  // namespace roomgraph
