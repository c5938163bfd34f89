// SPDX-License-Identifier: BSD-3-Clause
// Distance of closures from the estimate, and agreement of two closures.
#include "roomgraph/estimation/closure_gate.h"

#include <algorithm>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kSmall_m = 0.3, kSmall_rad = 0.15;  // moves the estimate so little that it needs no witness
constexpr double kSame_m = 0.2, kSame_rad = 0.1;   // of two closures that say the same
// More drift between two closures says nothing of them.
constexpr double kComparable_m = 0.5, kComparable_rad = 0.3;
constexpr double kOtherView_s = 0.5;
constexpr double kWidth = 3;  // standard deviations of the drift between the two
constexpr std::size_t kWaiting = 50;

bool isNear(const RelativePose& closure, const KeyPoses& poses) {
  const Pose3 difference = poses.differenceFrom(closure);
  return difference.translation().norm() < kSmall_m && rotationAngle(difference) < kSmall_rad;
}

// What the first says of the second's two times is what that says itself.
bool agree(const RelativePose& first, const RelativePose& second, const KeyPoses& poses, const Drift& drift) {
  if (std::abs(first.t_b - second.t_b) < kOtherView_s) return false;
  const Pose3 a = poses.at(second.t_a).inverse() * poses.at(first.t_a),
              b = poses.at(first.t_b).inverse() * poses.at(second.t_b);
  const Pose3 difference = second.a_from_b.inverse() * (a * first.a_from_b * b);
  const double drifted =
      kWidth * std::sqrt(drift.variance(poses, first.t_b, poses.at(second.t_b).translation().head<2>()));
  const double turned = kWidth * std::sqrt(drift.turned(poses, first.t_b));
  if (drifted > kComparable_m || turned > kComparable_rad) return false;
  return difference.translation().norm() < kSame_m + drifted &&
         rotationAngle(difference) < kSame_rad + turned;
}

}  // namespace

std::vector<RelativePose> ClosureGate::admit(const std::vector<RelativePose>& offered, const KeyPoses& poses,
                                             const Drift& drift) {
  std::vector<RelativePose> out;
  std::erase_if(waiting_, [&](const RelativePose& closure) {
    const bool now = isNear(closure, poses);
    if (now) out.push_back(closure);
    return now;
  });
  for (const RelativePose& closure : offered) {
    if (!drift.tellsFromRival(poses, closure)) {
      ++refused_;
      continue;
    }
    if (!needsWitness(closure) || isNear(closure, poses)) {
      out.push_back(closure);
      continue;
    }
    if (drift.contradicts(poses, closure)) {
      ++refused_;
      continue;
    }
    const auto witness = std::find_if(waiting_.begin(), waiting_.end(), [&](const RelativePose& other) {
      return agree(other, closure, poses, drift);
    });
    if (witness == waiting_.end()) {
      waiting_.push_back(closure);
      if (waiting_.size() > kWaiting) waiting_.erase(waiting_.begin());
      continue;
    }
    out.push_back(*witness);
    out.push_back(closure);
    waiting_.erase(witness);
  }
  return out;
}

}  // namespace roomgraph
