// SPDX-License-Identifier: BSD-3-Clause
// Curves over time of positions and errors.
#include "pose_curves.h"

#include <algorithm>
#include <cmath>

#include "path_thinning.h"
#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr int kCurveBins = 480;  // most that a screen shows
constexpr double kLeastGap_s = 1, kGapInSpacings = 10;
using Samples = std::vector<std::pair<double, double>>;

BinnedSeries curveOf(const Samples& samples, double duration_s) {
  return binned(samples, 0, duration_s, partsFor(samples.size(), kCurveBins));
}

}  // namespace

std::vector<PathPoint> seenFromAbove(const Trajectory& trajectory, double start_t) {
  std::vector<PathPoint> path;
  for (const auto& stamped : trajectory.poses()) {
    const Pose2 pose = planarPart(stamped.pose);
    path.push_back({stamped.t - start_t, pose.x, pose.y, pose.yaw});
  }
  return path;
}

double longestSpacing(const std::vector<PathPoint>& path) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < path.size(); ++i) spacing.push_back(path[i].t - path[i - 1].t);
  return std::max(kLeastGap_s, kGapInSpacings * summarize(spacing).median);
}

std::vector<std::pair<double, double>> gapsOf(const std::vector<PathPoint>& path) {
  const double longest_s = longestSpacing(path);
  std::vector<std::pair<double, double>> gaps;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i].t - path[i - 1].t > longest_s) gaps.emplace_back(path[i - 1].t, path[i].t);
  return gaps;
}

double lengthOf(const std::vector<PathPoint>& path) {
  double length_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length_m += std::hypot(path[i].x - path[i - 1].x, path[i].y - path[i - 1].y);
  return length_m;
}

std::optional<ReportedErrors> errorsOf(const Trajectory& truth, const Trajectory& estimate, double start_t,
                                       double duration_s) {
  ReportedErrors out{evaluateTrajectory(truth, estimate), {}, {}, 0};
  if (out.figures.pairs == 0) return std::nullopt;
  Samples position_m, rotation_deg;
  for (const auto& pair : associate(truth, estimate, {})) {
    const Pose3 error = pair.truth.inverse() * out.figures.truth_from_estimate * pair.estimate;
    position_m.emplace_back(pair.t - start_t, error.translation().norm());
    rotation_deg.emplace_back(pair.t - start_t, rotationAngle(error) * kDegreesPerRadian);
  }
  for (const auto& [t, degrees] : rotation_deg) out.mean_rotation_deg += degrees / static_cast<double>(rotation_deg.size());
  out.position_m = curveOf(position_m, duration_s);
  out.rotation_deg = curveOf(rotation_deg, duration_s);
  return out;
}

BinnedSeries hindsightOf(const Trajectory& live, const Trajectory& final, double start_t, double duration_s) {
  Samples moved_m;
  auto at = final.poses().begin();
  for (const auto& pose : live.poses()) {
    while (at != final.poses().end() && at->t < pose.t) ++at;
    if (at == final.poses().end()) break;
    if (at->t == pose.t)
      moved_m.emplace_back(pose.t - start_t, (at->pose.translation() - pose.pose.translation()).norm());
  }
  return curveOf(moved_m, duration_s);
}

}  // namespace roomgraph
