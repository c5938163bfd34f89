// SPDX-License-Identifier: BSD-3-Clause
// Lidar returns binned by bearing and compared with horizontal rays of the depth image.
#include "range_agreement.h"

#include <array>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kLongestWait_s = 0.25;
constexpr double kHorizontal = 0.05;  // slope of a ray
constexpr double kNearest_m = 0.5;    // nearer returns depend on where exactly the sensors sit
constexpr double kFarthestRange_m = 1e4;
constexpr std::size_t kLeastRatios = 200;

constexpr int kBins = 360;
int binOf(double x, double y) {
  return static_cast<int>(std::floor((std::atan2(y, x) + M_PI) / (2 * M_PI) * kBins)) % kBins;
}

}  // namespace

void RangeAgreement::addImage(double t, const PointGrid& grid, const Pose3& robot_from_sensor) {
  if (!scan_ || std::abs(t - scan_->t) > kLongestWait_s) return;
  const Eigen::Vector3d center = robot_from_sensor.translation();
  std::array<double, kBins> nearest{};  // of the lidar's returns as seen from the camera; 0: none
  for (const auto& point : scan_->pointsInRobot()) {
    const Eigen::Vector3d seen = point - center;
    const double distance = std::hypot(seen.x(), seen.y());
    if (!(distance < kFarthestRange_m)) continue;  // also what is not finite
    double& bin = nearest[static_cast<std::size_t>(binOf(seen.x(), seen.y()))];
    if (bin == 0 || distance < bin) bin = distance;
  }
  for (const auto& point : grid.points) {
    const Eigen::Vector3d seen = robot_from_sensor.linear() * point;
    const double distance = std::hypot(seen.x(), seen.y());
    if (!(distance > 0 && distance < kFarthestRange_m && std::abs(seen.z()) < kHorizontal * distance))
      continue;
    const double expected = nearest[static_cast<std::size_t>(binOf(seen.x(), seen.y()))];
    if (expected > kNearest_m) ratios_.push_back(distance / expected);
  }
}

std::optional<double> RangeAgreement::ratio() const {
  if (ratios_.size() < kLeastRatios) return std::nullopt;
  return median(ratios_);
}

}  // namespace roomgraph
