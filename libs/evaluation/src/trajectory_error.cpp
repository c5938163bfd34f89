// SPDX-License-Identifier: BSD-3-Clause
// Pose pairs by time stamp, relative errors over a fixed interval, and coverage.
#include "roomgraph/evaluation/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

std::size_t lowerBound(const GrowingList<StampedPose>& poses, double t) {
  return static_cast<std::size_t>(
      std::lower_bound(poses.begin(), poses.end(), t,
                       [](const StampedPose& p, double time) { return p.t < time; }) -
      poses.begin());
}

std::size_t nearest(const GrowingList<StampedPose>& poses, double t) {
  const std::size_t right = lowerBound(poses, t);
  if (right == 0) return 0;
  if (right == poses.size()) return right - 1;
  return t - poses[right - 1].t <= poses[right].t - t ? right - 1 : right;
}

std::vector<PosePair> associateInterpolated(const Trajectory& truth, const Trajectory& estimate,
                                            const TrajectoryOptions& options) {
  std::vector<PosePair> pairs;
  for (const auto& pose : estimate.poses()) {
    const std::size_t right = lowerBound(truth.poses(), pose.t);
    const bool between = right > 0 && right < truth.size() && truth.poses()[right].t > pose.t;
    if (between && truth.poses()[right].t - truth.poses()[right - 1].t > options.max_gap_s) continue;
    if (const auto at = truth.at(pose.t)) pairs.push_back({pose.t, *at, pose.pose});
  }
  return pairs;
}

double medianSpacing(const std::vector<PosePair>& pairs) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < pairs.size(); ++i) spacing.push_back(pairs[i].t - pairs[i - 1].t);
  return summarize(spacing).median;
}

// The pair at the given distance in time after pair i; nothing in a gap of the data.
std::optional<std::size_t> partner(const std::vector<PosePair>& pairs, std::size_t i, double tolerance_s,
                                   const TrajectoryOptions& options) {
  if (options.rpe_delta_frames > 0) {
    const std::size_t j = i + static_cast<std::size_t>(options.rpe_delta_frames);
    return j < pairs.size() ? std::optional(j) : std::nullopt;
  }
  const double wanted = pairs[i].t + options.rpe_delta_s;
  const auto after = std::lower_bound(pairs.begin(), pairs.end(), wanted,
                                      [](const PosePair& pair, double t) { return pair.t < t; });
  std::size_t j = static_cast<std::size_t>(after - pairs.begin());
  if (j == pairs.size() || (j > 0 && wanted - pairs[j - 1].t <= pairs[j].t - wanted)) --j;
  if (j <= i || std::abs(pairs[j].t - wanted) > tolerance_s) return std::nullopt;
  return j;
}

void addRelativeErrors(const std::vector<PosePair>& pairs, const TrajectoryOptions& options,
                       TrajectoryErrors& out) {
  std::vector<double> trans, rot;
  const double tolerance_s = std::max(options.max_difference_s, medianSpacing(pairs) / 2 * (1 + 1e-6));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto j = partner(pairs, i, tolerance_s, options);
    if (!j) continue;
    const Pose3 truth = pairs[i].truth.inverse() * pairs[*j].truth;
    const Pose3 estimate = pairs[i].estimate.inverse() * pairs[*j].estimate;
    const Pose3 error = truth.inverse() * estimate;
    trans.push_back(error.translation().norm());
    rot.push_back(rotationAngle(error) * kDegreesPerRadian);
  }
  out.rpe_trans_m = summarize(trans);
  out.rpe_rot_deg = summarize(rot);
}

double coveredShare(const std::vector<PosePair>& pairs, const Trajectory& truth, double max_gap_s) {
  if (pairs.empty()) return 0;
  const double span = truth.lastTime() - truth.firstTime();
  if (!(span > 0)) return 1;
  double covered = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i)
    if (pairs[i].t - pairs[i - 1].t <= max_gap_s) covered += pairs[i].t - pairs[i - 1].t;
  return std::min(1.0, covered / span);
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                const TrajectoryOptions& options) {
  if (truth.empty() || estimate.empty()) return {};
  if (options.interpolate_truth) return associateInterpolated(truth, estimate, options);
  std::map<std::size_t, std::size_t> estimate_of_truth;
  const auto gap = [&](std::size_t i, std::size_t j) {
    return std::abs(truth.poses()[i].t - estimate.poses()[j].t);
  };
  for (std::size_t j = 0; j < estimate.size(); ++j) {
    const std::size_t i = nearest(truth.poses(), estimate.poses()[j].t);
    if (gap(i, j) > options.max_difference_s) continue;
    const auto [entry, inserted] = estimate_of_truth.try_emplace(i, j);
    if (!inserted && gap(i, j) < gap(i, entry->second)) entry->second = j;
  }
  std::vector<PosePair> pairs;
  for (const auto& [i, j] : estimate_of_truth)
    pairs.push_back({estimate.poses()[j].t, truth.poses()[i].pose, estimate.poses()[j].pose});
  return pairs;
}

TrajectoryErrors evaluateTrajectory(const Trajectory& truth, const Trajectory& estimate,
                                    const TrajectoryOptions& options) {
  const auto pairs = associate(truth, estimate, options);
  TrajectoryErrors out;
  out.truth_poses = static_cast<int>(truth.size());
  out.estimated_poses = static_cast<int>(estimate.size());
  out.pairs = static_cast<int>(pairs.size());
  out.coverage = coveredShare(pairs, truth, options.max_gap_s);
  out.matched_share =
      estimate.empty() ? 0 : static_cast<double>(pairs.size()) / static_cast<double>(estimate.size());
  if (options.align) out.truth_from_estimate = align(pairs);
  std::vector<double> distances;
  for (const auto& pair : pairs)
    distances.push_back(
        (out.truth_from_estimate * pair.estimate.translation() - pair.truth.translation()).norm());
  out.ate_m = summarize(distances);
  addRelativeErrors(pairs, options, out);
  return out;
}

}  // namespace roomgraph
