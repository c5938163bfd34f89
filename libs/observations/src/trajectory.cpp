// SPDX-License-Identifier: BSD-3-Clause
// Interpolation and bounded extrapolation within segments of a trajectory.
#include "roomgraph/observations/trajectory.h"

#include <algorithm>
#include <stdexcept>

namespace roomgraph {

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
  std::size_t right = static_cast<std::size_t>(after - poses_.begin());
  if (poses_.size() == 1) return poses_.front().pose;
  const bool inside = right > 0 && right < poses_.size();
  right = std::clamp<std::size_t>(right, 1, poses_.size() - 1);
  const std::size_t left = right - 1;
  if (segments_[left] != segments_[right]) {
    if (inside) return std::nullopt;
    return t < poses_.front().t ? poses_.front().pose : poses_.back().pose;
  }
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
