// SPDX-License-Identifier: BSD-3-Clause
// Sums of costs on a grid of offsets, and the parabola about the least.
#include "roomgraph/estimation/clock_comparison.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace roomgraph {
namespace {

constexpr double kRange_s = 1, kCell_s = 0.02;
constexpr int kHalf = 50;                          // cells of the range
constexpr double kStep_s = 0.3, kLongestStep_s = 1;  // of movements that are compared
constexpr double kDense_s = 0.55;                  // between poses of the reference
constexpr std::array kNoises = {0.001, 0.002, 0.004, 0.008, 0.016};  // m and rad, of which that of the two sensors is one
constexpr double kTells_m = 0.02, kTells_rad = 0.02;  // by which movements of the reference differ, to tell offsets apart
constexpr double kLasting = 0.995, kRecent = 0.95;  // share that is left after another movement
constexpr double kJump_s = 0.15;                   // of a clock
constexpr int kLeastTold = 30;                     // movements: of few their noise is not known
constexpr int kNear = 5;                           // cells about the least that need not differ from it
constexpr double kDistinct = 8;                    // by how much the others must

struct Step {
  double length = 0, turn = 0;  // m, negative backwards; rad
};

std::optional<Step> stepOf(const Trajectory& path, double from_t, double until_t) {
  const auto moved = path.between(from_t, until_t);
  if (!moved) return std::nullopt;
  const Pose2 planar = planarPart(*moved);
  return Step{std::copysign(std::hypot(planar.x, planar.y), planar.x), planar.yaw};
}

bool isDense(const Trajectory& path, double t) {
  const auto& poses = path.poses();
  const auto after = std::lower_bound(poses.begin(), poses.end(), t, [](const StampedPose& pose, double time) { return pose.t < time; });
  return after != poses.end() && after != poses.begin() && after->t - std::prev(after)->t <= kDense_s;
}

double costOf(const Step& a, const Step& b, double noise) {
  const double m = (a.length - b.length) / noise, rad = wrapAngle(a.turn - b.turn) / noise;
  return std::log1p(m * m) + std::log1p(rad * rad) + 2 * std::log(noise);
}

// Whether they are not one like the other.
bool tells(const std::vector<Step>& steps) {
  const auto shorter = [](const Step& a, const Step& b) { return a.length < b.length; };
  const auto turnsLess = [](const Step& a, const Step& b) { return a.turn < b.turn; };
  const auto [near, far] = std::minmax_element(steps.begin(), steps.end(), shorter);
  const auto [right, left] = std::minmax_element(steps.begin(), steps.end(), turnsLess);
  return far->length - near->length > kTells_m || left->turn - right->turn > kTells_rad;
}

std::optional<TimeOffset> leastOf(const std::vector<std::vector<double>>& all) {
  const auto leastCost = [](const std::vector<double>& costs) { return *std::min_element(costs.begin(), costs.end()); };
  const auto& costs = *std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) { return leastCost(a) < leastCost(b); });
  const auto least = std::min_element(costs.begin(), costs.end());
  const auto at = static_cast<int>(least - costs.begin());
  if (at == 0 || at == 2 * kHalf) return std::nullopt;
  for (int i = 0; i <= 2 * kHalf; ++i)
    if (std::abs(i - at) > kNear && costs[static_cast<std::size_t>(i)] < *least + kDistinct) return std::nullopt;
  const double before = *std::prev(least), after = *std::next(least), bend = before + after - 2 * *least;
  if (bend <= 0) return std::nullopt;
  return TimeOffset{(at - kHalf + 0.5 * (before - after) / bend) * kCell_s, kCell_s / std::sqrt(bend)};
}

}  // namespace

ClockComparison::ClockComparison() { forget(); }

void ClockComparison::forget() {
  lasting_.assign(kNoises.size(), std::vector<double>(2 * kHalf + 1, 0));
  recent_ = lasting_;
  told_ = 0;
}

bool ClockComparison::compare(const Trajectory& sensor, const Trajectory& reference, double after_t) {
  const auto& poses = sensor.poses();
  bool jumped = false;
  if (reference.empty()) return jumped;
  while (next_ < poses.size()) {
    if (poses[next_].t <= after_t) {
      ++next_;
      continue;
    }
    const double from_t = poses[next_].t;
    std::size_t last = next_ + 1;
    while (last < poses.size() && poses[last].t < from_t + kStep_s) ++last;
    if (last >= poses.size() || poses[last].t + kRange_s > reference.lastTime()) break;
    learn(sensor, reference, from_t, poses[last].t);
    jumped = hasJumped() || jumped;
    next_ = last;
  }
  return jumped;
}

void ClockComparison::learn(const Trajectory& sensor, const Trajectory& reference, double from_t, double until_t) {
  if (until_t - from_t > kLongestStep_s || !isDense(reference, from_t) || !isDense(reference, until_t)) return;
  const auto seen = stepOf(sensor, from_t, until_t);
  if (!seen) return;
  std::vector<Step> steps;
  for (int i = -kHalf; i <= kHalf; ++i) {
    const auto step = stepOf(reference, from_t + i * kCell_s, until_t + i * kCell_s);
    if (!step) return;
    steps.push_back(*step);
  }
  if (!tells(steps)) return;
  ++told_;
  for (std::size_t n = 0; n < kNoises.size(); ++n)
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double cost = costOf(*seen, steps[i], kNoises[n]);
      lasting_[n][i] = kLasting * lasting_[n][i] + cost;
      recent_[n][i] = kRecent * recent_[n][i] + cost;
    }
}

bool ClockComparison::hasJumped() {
  if (told_ < kLeastTold) return false;
  const auto lasting = leastOf(lasting_), recent = leastOf(recent_);
  if (!lasting || !recent || std::abs(lasting->seconds - recent->seconds) < kJump_s) return false;
  lasting_ = recent_;
  return true;
}

std::optional<TimeOffset> ClockComparison::offset() const {
  if (told_ < kLeastTold) return std::nullopt;
  return leastOf(lasting_);
}

}  // namespace roomgraph
