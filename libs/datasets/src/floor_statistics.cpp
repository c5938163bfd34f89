// SPDX-License-Identifier: BSD-3-Clause
// Robust agreement of floor sightings by medians and their deviations.
#include "floor_statistics.h"

#include <algorithm>
#include <cmath>

#include "floor_search.h"
#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr std::size_t kLeastSightings = 3;
constexpr double kLeastShareOfImages = 0.25;                    // of the images that show the floor
constexpr double kSpreadM = 0.02, kSpreadShare = 0.02;  // of the heights; median deviation
constexpr double kSpreadRad = 0.02;                     // of the directions

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

void FloorStatistics::add(const PointGrid& grid, const Pose3& robot_from_sensor) {
  if (grid.points.empty()) return;
  ++images_;
  if (!robot_from_sensor_) robot_from_sensor_ = robot_from_sensor;
  const Eigen::Vector3d up = robot_from_sensor.linear().transpose() * Eigen::Vector3d::UnitZ();
  if (const auto floor = findFloor(grid, up)) by_pose_.push_back({floor->normal, floor->offset});
  if (const auto floor = findFloor(grid, Eigen::Vector3d::UnitZ()))
    by_image_.push_back({floor->normal, floor->offset});
}

FloorStatistics::Sighting FloorStatistics::middleOf(const std::vector<Sighting>& sightings) {
  const auto medianOf = [&](const auto& value) {
    std::vector<double> values;
    for (const Sighting& s : sightings) values.push_back(value(s));
    return median(values);
  };
  Sighting middle;
  for (int i = 0; i < 3; ++i) middle.up[i] = medianOf([i](const Sighting& s) { return s.up[i]; });
  middle.up.normalize();
  middle.height_m = medianOf([](const Sighting& s) { return s.height_m; });
  return middle;
}

FloorSpread FloorStatistics::spreadOf(const std::vector<Sighting>& sightings, const Sighting& middle) {
  std::vector<double> heights_m, directions_rad;
  for (const Sighting& s : sightings) {
    heights_m.push_back(std::abs(s.height_m - middle.height_m));
    directions_rad.push_back(angleBetween(s.up, middle.up));
  }
  return {median(heights_m), median(directions_rad)};
}

std::optional<FloorStatistics::Sighting> FloorStatistics::agreed(const std::vector<Sighting>& sightings) {
  const Sighting middle = middleOf(sightings);
  const FloorSpread spread = spreadOf(sightings, middle);
  if (spread.height_m > kSpreadM + kSpreadShare * middle.height_m || spread.direction_rad > kSpreadRad) return std::nullopt;
  return middle;
}

bool FloorStatistics::enough(const std::vector<Sighting>& sightings) const {
  return sightings.size() >= kLeastSightings &&
         static_cast<double>(sightings.size()) >= kLeastShareOfImages * images_;
}

std::optional<FloorSpread> FloorStatistics::spread() const {
  if (report() || !enough(by_pose_)) return std::nullopt;
  return spreadOf(by_pose_, middleOf(by_pose_));
}

std::optional<FloorSummary> FloorStatistics::report() const {
  for (const auto* sightings : {&by_pose_, &by_image_}) {
    if (!enough(*sightings)) continue;
    const auto seen = agreed(*sightings);
    if (!seen) continue;
    FloorSummary out;
    out.images = static_cast<int>(sightings->size());
    out.sensor_height_m = seen->height_m;
    const Eigen::Vector3d up = robot_from_sensor_->linear() * seen->up;
    out.tilt_rad = angleBetween(up, Eigen::Vector3d::UnitZ());
    out.fitting_pose = *robot_from_sensor_;
    out.fitting_pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()) * robot_from_sensor_->linear();
    out.fitting_pose.translation().z() = seen->height_m;
    return out;
  }
  return std::nullopt;
}

}  // namespace roomgraph
