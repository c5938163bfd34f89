// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry with scale error, drift, noise and slips.
#include <algorithm>
#include <cmath>
#include <set>

#include "sensors.h"

namespace roomgraph {

std::vector<Pose2> measureOdometry(const std::vector<Pose2>& truth, const OdometrySpec& spec, Random random) {
  // Slips happen at random readings; each lasts for one reading.
  std::set<std::size_t> slips;
  for (int i = 0; i < spec.slips && truth.size() > 1; ++i)
    slips.insert(1 + static_cast<std::size_t>(random.uniform() * static_cast<double>(truth.size() - 1)));
  std::vector<Pose2> out(truth.size());
  for (std::size_t i = 1; i < truth.size(); ++i) {
    Pose2 step = truth[i - 1].inverse() * truth[i];
    const double length = std::hypot(step.x, step.y), turn = std::abs(step.yaw);
    const double gain =
        1 + spec.scale_error + (length > 0 ? spec.sigma_length * random.normal() / std::sqrt(length) : 0);
    step.x *= gain;
    step.y *= gain;
    step.yaw += spec.turn_error * step.yaw + spec.drift_rad_m * length +
                spec.sigma_turn * std::sqrt(turn) * random.normal();
    if (slips.count(i)) {
      step.x += spec.slip_m * random.normal();
      step.yaw += spec.slip_rad * random.normal();
    }
    out[i] = out[i - 1] * step;
  }
  return out;
}

}  // namespace roomgraph
