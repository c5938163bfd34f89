// SPDX-License-Identifier: BSD-3-Clause
// Reader of poses with quaternion or yaw; sorting and removal of repeated stamps.
#include "roomgraph/evaluation/trajectory_file.h"

#include <algorithm>
#include <cmath>

#include "number_table.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr double kQuaternionTolerance = 0.05;  // of the norm; files round to four digits at worst

StampedPose toPose(const NumberRow& row) {
  const auto& v = row.values;
  if (v.size() == 4) return {v[0], toPose3(Pose2{v[1], v[2], v[3]})};
  if (v.size() != 8)
    throw InputError(row.place + ": expected 8 columns (t tx ty tz qx qy qz qw) or 4 (t x y yaw), got " +
                     std::to_string(v.size()));
  const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > kQuaternionTolerance)
    throw InputError(row.place + ": quaternion has norm " + std::to_string(q.norm()) + ", not 1");
  StampedPose out{v[0], Pose3::Identity()};
  out.pose.linear() = q.normalized().toRotationMatrix();
  out.pose.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  return out;
}

}  // namespace

TrajectoryFile readTrajectory(const std::filesystem::path& file) {
  const auto rows = readNumberTable(file);
  if (rows.empty()) throw InputError(file.string() + ": holds no pose");
  TrajectoryFile out;
  out.planar = rows.front().values.size() == 4;
  std::vector<StampedPose> poses;
  for (const auto& row : rows) {
    if (row.values.size() != rows.front().values.size())
      throw InputError(row.place + ": has " + std::to_string(row.values.size()) +
                       " columns, the first pose (" + rows.front().place + ") has " +
                       std::to_string(rows.front().values.size()));
    poses.push_back(toPose(row));
  }
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.t < b.t; };
  out.sorted = std::is_sorted(poses.begin(), poses.end(), earlier);
  std::stable_sort(poses.begin(), poses.end(), earlier);
  for (const auto& stamped : poses) {
    if (!out.trajectory.empty() && stamped.t == out.trajectory.lastTime()) {
      ++out.duplicates;
    } else {
      out.trajectory.add(stamped.t, stamped.pose);
    }
  }
  return out;
}

}  // namespace roomgraph
