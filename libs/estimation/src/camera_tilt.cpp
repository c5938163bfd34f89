// SPDX-License-Identifier: BSD-3-Clause
// Medians of floor planes, and how many of them agree.
#include "roomgraph/estimation/camera_tilt.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kEvery_s = 1, kEvery_m = 0.1, kEvery_rad = 0.1;
constexpr int kMostImages = 100;
constexpr double kMostTilt_rad = 0.4, kHeight_m = 0.05, kHeightShare = 0.1;  // a plane beyond these is no floor
constexpr std::size_t kLeastSeen = 10;
constexpr double kLeastShare = 0.6, kLikeMedian_m = 0.03, kLikeMedianShare = 0.02, kLikeMedian_rad = 0.03;

double angleOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

bool CameraTilt::wants(double t, const Pose2& robot) const {
  if (!last_t_) return true;
  const Pose2 moved = last_place_.inverse() * robot;
  return images_ < kMostImages && t >= *last_t_ + kEvery_s && (std::hypot(moved.x, moved.y) >= kEvery_m || std::abs(moved.yaw) >= kEvery_rad);
}

void CameraTilt::add(double t, const Pose2& robot, const std::optional<Plane>& in_robot, const Eigen::Vector3d& camera_in_robot) {
  last_t_ = t;
  last_place_ = robot;
  ++images_;
  if (!in_robot) return;
  const double height_m = in_robot->distance(camera_in_robot), expected_m = camera_in_robot.z();
  if (std::abs(height_m - expected_m) > kHeight_m + kHeightShare * expected_m) return;
  if (angleOf(in_robot->normal, Eigen::Vector3d::UnitZ()) > kMostTilt_rad) return;
  seen_.push_back({in_robot->normal, height_m});
}

std::optional<Eigen::Vector3d> CameraTilt::up() const {
  if (seen_.empty()) return std::nullopt;
  const auto medianOver = [this](const auto& value) {
    std::vector<double> values;
    for (const Sighting& one : seen_) values.push_back(value(one));
    return median(std::move(values));
  };
  Eigen::Vector3d up;
  for (int i = 0; i < 3; ++i) up[i] = medianOver([i](const Sighting& one) { return one.up[i]; });
  up.normalize();
  const double height_m = medianOver([](const Sighting& one) { return one.height_m; });
  const auto agreeing = static_cast<std::size_t>(std::count_if(seen_.begin(), seen_.end(), [&](const Sighting& one) {
    return std::abs(one.height_m - height_m) < kLikeMedian_m + kLikeMedianShare * height_m && angleOf(one.up, up) < kLikeMedian_rad;
  }));
  if (agreeing < kLeastSeen || static_cast<double>(agreeing) < kLeastShare * images_) return std::nullopt;
  return up;
}

}  // namespace roomgraph
