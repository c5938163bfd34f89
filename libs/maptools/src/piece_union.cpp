// SPDX-License-Identifier: BSD-3-Clause
// Alignment by common instants, correction by the maps, paths that go over into each other.
#include "roomgraph/maptools/piece_union.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/maptools/map_alignment.h"
#include "roomgraph/maptools/map_union.h"
#include "roomgraph/observations/trajectory.h"

namespace roomgraph {
namespace {

// Pieces of one recording overlap in time: hardly anything was carried off between them.
const MapDifferenceOptions kOneRecording{.moves = 0.01, .vanishes = 0.01, .appears = 0.01};

constexpr double kSameInstant_s = 1e-6;
constexpr std::size_t kLeastPoses = 5;
constexpr double kMostApart_m = 0.5;
constexpr double kAgrees_m = 0.5, kAgrees_rad = 0.1;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Poses of b with those of a at the same instant.
std::vector<std::pair<Pose2, Pose2>> commonPoses(const std::vector<StampedPose>& a,
                                                 const std::vector<StampedPose>& b) {
  std::vector<std::pair<Pose2, Pose2>> out;
  auto there = a.begin();
  for (const auto& stamped : b) {
    while (there != a.end() && there->t < stamped.t - kSameInstant_s) ++there;
    if (there == a.end()) break;
    if (there->t <= stamped.t + kSameInstant_s)
      out.emplace_back(planarPart(there->pose), planarPart(stamped.pose));
  }
  return out;
}

// Angles about the first one, so that none of them is torn apart at pi.
double medianAngle(const std::vector<double>& angles) {
  std::vector<double> turned;
  for (const double angle : angles) turned.push_back(wrapAngle(angle - angles.front()));
  return wrapAngle(angles.front() + median(turned));
}

Trajectory trajectoryOf(const std::vector<StampedPose>& path) {
  Trajectory out;
  for (const auto& stamped : path) out.add(stamped.t, stamped.pose);
  return out;
}

}  // namespace

Outcome<PathAlignment> alignPaths(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
  const auto common = commonPoses(a, b);
  if (common.size() < kLeastPoses)
    return Outcome<PathAlignment>::failure("the pieces have " + std::to_string(common.size()) +
                                           " instants in common, fewer than " + std::to_string(kLeastPoses));
  PathAlignment out;
  out.poses = static_cast<int>(common.size());
  std::vector<double> turns, x, y;
  for (const auto& [in_a, in_b] : common) turns.push_back(in_a.yaw - in_b.yaw);
  out.a_from_b.yaw = medianAngle(turns);
  for (const auto& [in_a, in_b] : common) {
    const Eigen::Vector2d turned = Pose2{0, 0, out.a_from_b.yaw} * Eigen::Vector2d(in_b.x, in_b.y);
    x.push_back(in_a.x - turned.x());
    y.push_back(in_a.y - turned.y());
  }
  out.a_from_b.x = median(x);
  out.a_from_b.y = median(y);
  double squares = 0;
  for (const auto& [in_a, in_b] : common) {
    const Eigen::Vector2d at(in_a.x, in_a.y);
    squares += (out.a_from_b * Eigen::Vector2d(in_b.x, in_b.y) - at).squaredNorm();
    out.middle += at / static_cast<double>(common.size());
  }
  out.rms_m = std::sqrt(squares / static_cast<double>(common.size()));
  if (out.rms_m > kMostApart_m) {
    char text[96];
    std::snprintf(text, sizeof text,
                  "the paths of the pieces differ by %.2f m where they are of the same time", out.rms_m);
    return Outcome<PathAlignment>::failure(text);
  }
  return out;
}

std::vector<StampedPose> joinedPaths(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  const double begin = b.front().t, end = a.back().t;
  if (begin > end) {
    std::vector<StampedPose> out = a;
    out.insert(out.end(), b.begin(), b.end());
    return out;
  }
  const Trajectory first = trajectoryOf(a), second = trajectoryOf(b);
  std::vector<StampedPose> out;
  for (const auto& stamped : a)
    if (stamped.t < begin) out.push_back(stamped);
  std::vector<double> instants;
  for (const auto* path : {&a, &b})
    for (const auto& stamped : *path)
      if (stamped.t >= begin && stamped.t <= end) instants.push_back(stamped.t);
  std::sort(instants.begin(), instants.end());
  for (const double t : instants) {
    if (!out.empty() && t <= out.back().t + kSameInstant_s) continue;
    const auto from = first.at(t), to = second.at(t);
    if (!from || !to) continue;
    out.push_back({t, interpolate(*from, *to, end > begin ? (t - begin) / (end - begin) : 1)});
  }
  for (const auto& stamped : b)
    if (stamped.t > end) out.push_back(stamped);
  return out;
}

Outcome<PieceUnion> unitedPieces(const CSemanticMap& a, const CSemanticMap& b) {
  const auto paths = alignPaths(a.world_from_robot, b.world_from_robot);
  if (!paths) return Outcome<PieceUnion>::failure(paths.reason());
  PieceUnion out;
  out.paths = *paths;
  MapAlignment alignment;
  alignment.a_from_b = paths->a_from_b;
  const auto by_maps = alignMaps(a, b);
  if (by_maps) {
    const Eigen::Vector2d there = paths->a_from_b.inverse() * paths->middle;
    out.by_maps = (by_maps->a_from_b * there - paths->middle).norm() < kAgrees_m &&
                  std::abs(wrapAngle(by_maps->a_from_b.yaw - paths->a_from_b.yaw)) < kAgrees_rad;
    if (out.by_maps)
      alignment = *by_maps;
    else
      out.why_not = "objects and walls would put it elsewhere";
  } else {
    out.why_not = by_maps.reason();
  }
  out.a_from_b = alignment.a_from_b;
  const CSemanticMap next = movedMap(b, alignment, a.occupancy.get());
  const SeenSpan common{std::max(a.world_from_robot.front().t, next.world_from_robot.front().t),
                        std::min(a.world_from_robot.back().t, next.world_from_robot.back().t)};
  out.map = unitedMaps(a, next, differenceOf(a, next, kOneRecording), common);
  out.map.world_from_robot = joinedPaths(a.world_from_robot, next.world_from_robot);
  out.map.origin = a.origin;
  auto& history = out.map.provenance.history;
  if (!history.empty() && history.back().starts_with("poses of ")) history.pop_back();
  return out;
}

}  // namespace roomgraph
