// SPDX-License-Identifier: BSD-3-Clause
// Interpolation and bounded extrapolation within segments of a trajectory.
#include "roomgraph/observations/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roomgraph/observations/trajectory_velocity.h"

namespace roomgraph {
namespace {
constexpr double kLeastStep_s = 0.015;  // poses less apart, stamped in a burst, tell no velocity
}  // namespace

std::optional<std::size_t> velocityBase(const Trajectory& trajectory, bool at_end) {
  if (trajectory.empty()) return std::nullopt;
  const std::size_t end = at_end ? trajectory.size() - 1 : 0;
  for (std::size_t steps = 1; steps < trajectory.size(); ++steps) {
    const std::size_t i = at_end ? end - steps : end + steps;
    if (trajectory.segment(i) != trajectory.segment(end)) break;
    if (std::abs(trajectory.poses()[i].t - trajectory.poses()[end].t) >= kLeastStep_s) return i;
  }
  return std::nullopt;
}

void Trajectory::add(double t, const Pose3& pose, int segment) {
  if (!poses_.empty() && t <= poses_.back().t)
    throw std::invalid_argument("Trajectory::add: time " + std::to_string(t) + " s does not come after " +
                                std::to_string(poses_.back().t) + " s");
  poses_.push_back({t, pose});
  segments_.push_back(segment);
}

std::optional<Pose3> Trajectory::at(double t, double horizon_s) const {
  if (poses_.empty() || t < firstTime() - horizon_s || t > lastTime() + horizon_s) return std::nullopt;
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), t,
                       [](const StampedPose& stamped, double time) { return stamped.t < time; });
  if (after != poses_.end() && after->t == t) return after->pose;
  const std::size_t right = static_cast<std::size_t>(after - poses_.begin());
  const bool at_end = right == poses_.size();
  if (right == 0 || at_end) {
    const std::size_t end = at_end ? right - 1 : 0;
    const auto base = velocityBase(*this, at_end);
    if (!base) return poses_[end].pose;
    return interpolate(poses_[*base].pose, poses_[end].pose, (t - poses_[*base].t) / (poses_[end].t - poses_[*base].t));
  }
  const std::size_t left = right - 1;
  if (segments_[left] != segments_[right]) return std::nullopt;
  return interpolate(poses_[left].pose, poses_[right].pose,
                     (t - poses_[left].t) / (poses_[right].t - poses_[left].t));
}

std::optional<Pose3> Trajectory::between(double t_a, double t_b, double horizon_s) const {
  const auto segment_at = [&](double t) {
    const auto after =
        std::lower_bound(poses_.begin(), poses_.end(), t,
                         [](const StampedPose& stamped, double time) { return stamped.t < time; });
    return after == poses_.end() ? segments_.back()
                                 : segments_[static_cast<std::size_t>(after - poses_.begin())];
  };
  const auto a = at(t_a, horizon_s), b = at(t_b, horizon_s);
  if (!a || !b || segment_at(t_a) != segment_at(t_b)) return std::nullopt;
  return a->inverse() * *b;
}

}  // namespace roomgraph
