// SPDX-License-Identifier: BSD-3-Clause
// Nearest piece between neighbouring returns for every depth point at the lidar's height.
#include "scan_agreement.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/core/order_statistics.h"

namespace roomgraph {
namespace {

constexpr double kSameTime_s = 0.05;
constexpr double kHeight_m = 0.1;  // above and below the lidar's
constexpr double kAboveFloor_m = 0.1;
constexpr double kFarthestPoint_m = 3.5;  // farther depth is too noisy
constexpr double kOtherSurface_m = 0.5;   // what is so far off is something that the lidar did not see
constexpr double kNeighbours_m = 0.3;     // between returns on one surface
constexpr std::size_t kLeastCompared = 200;

double toSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double length = d.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0;
  return (p - a - share * d).norm();
}

}  // namespace

void ScanAgreement::addScan(const Scan& scan) {
  scan_ = {scan.t, scan.robot_from_lidar.translation().z(), scan.pointsInRobot()};
  compare();
}

void ScanAgreement::addImage(double t, const PointGrid& grid, const Pose3& robot_from_sensor) {
  image_ = SeenPoints{t, 0, {}};
  for (const auto& point : grid.points)
    if (!point.isZero()) image_->points.push_back(robot_from_sensor * point);
  compare();
}

// An image is compared once, with whichever scan is near enough in time first.
void ScanAgreement::compare() {
  if (!scan_ || !image_ || std::abs(scan_->t - image_->t) > kSameTime_s) return;
  for (const auto& point : image_->points) {
    const Eigen::Vector2d p = point.head<2>();
    if (std::abs(point.z() - scan_->height_m) > kHeight_m || point.z() < kAboveFloor_m ||
        !(p.norm() < kFarthestPoint_m))
      continue;
    double nearest = kOtherSurface_m;
    for (std::size_t i = 1; i < scan_->points.size(); ++i) {
      const Eigen::Vector2d a = scan_->points[i - 1].head<2>(), b = scan_->points[i].head<2>();
      if ((a - b).squaredNorm() < kNeighbours_m * kNeighbours_m)
        nearest = std::min(nearest, toSegment(p, a, b));
    }
    if (nearest < kOtherSurface_m) distances_.push_back(nearest);
  }
  image_.reset();
}

std::optional<double> ScanAgreement::distance() const {
  if (distances_.size() < kLeastCompared) return std::nullopt;
  return median(distances_);
}

}  // namespace roomgraph
