// SPDX-License-Identifier: BSD-3-Clause
// Split-and-merge line extraction and its line fit.
#include "scan_walls.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>
#include <utility>

namespace roomgraph {
namespace {

constexpr std::size_t kLeastReturns = 8;
constexpr double kLeastLength_m = 0.4;
constexpr double kGap_m = 0.12, kGapShare = 0.12;      // between neighbours: of the range, but no less
constexpr double kThick_m = 0.05, kThickShare = 0.04;  // farthest return from a line that is one piece
constexpr std::size_t kLeftOut = 1;                    // returns at each end, which may be on two surfaces

using Points = std::vector<Eigen::Vector2d>;
using Range = std::pair<std::size_t, std::size_t>;  // from, to (not included)

bool areApart(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - b).norm() > std::max(kGap_m, kGapShare * std::min(a.norm(), b.norm()));
}

std::optional<std::size_t> farthest(const Points& p, const Range& r) {
  const Eigen::Vector2d start = p[r.first], d = (p[r.second - 1] - start).normalized();
  double most = 0;
  std::optional<std::size_t> at;
  for (std::size_t i = r.first + 1; i + 1 < r.second; ++i) {
    const double off = std::abs(d.x() * (p[i] - start).y() - d.y() * (p[i] - start).x());
    if (off > std::max(kThick_m, kThickShare * p[i].norm()) && off > most) {
      most = off;
      at = i;
    }
  }
  return at;
}

void split(const Points& p, const Range& r, std::vector<Range>& out) {
  if (r.second - r.first < kLeastReturns) return;
  const auto at = farthest(p, r);
  if (!at) {
    out.push_back(r);
    return;
  }
  split(p, {r.first, *at + 1}, out);
  split(p, {*at, r.second}, out);
}

std::optional<ScanWall> fitWall(const Points& p, Range r) {
  r = {r.first + kLeftOut, r.second - kLeftOut};
  const auto count = static_cast<double>(r.second - r.first);
  if (count < static_cast<double>(kLeastReturns - 2 * kLeftOut)) return std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = r.first; i < r.second; ++i) mean += p[i] / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t i = r.first; i < r.second; ++i) scatter += (p[i] - mean) * (p[i] - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  ScanWall wall;
  wall.normal = axes.eigenvectors().col(0);
  if (wall.normal.dot(mean) > 0) wall.normal = -wall.normal;
  wall.along = {-wall.normal.y(), wall.normal.x()};
  wall.distance_m = wall.normal.dot(mean);
  wall.from_m = wall.to_m = wall.middle_m = wall.along.dot(mean);
  for (std::size_t i = r.first; i < r.second; ++i) {
    wall.from_m = std::min(wall.from_m, wall.along.dot(p[i]));
    wall.to_m = std::max(wall.to_m, wall.along.dot(p[i]));
  }
  wall.sigma_m = std::sqrt(std::max(axes.eigenvalues()(0), 0.0) / (count - 2) / count);
  wall.spread_m = std::sqrt(axes.eigenvalues()(1) / count);
  if (wall.to_m - wall.from_m < kLeastLength_m) return std::nullopt;
  return wall;
}

}  // namespace

double ScanWall::sigmaAt(double along_m) const {
  return sigma_m * std::sqrt(1 + std::pow((along_m - middle_m) / spread_m, 2));
}

std::vector<ScanWall> findScanWalls(const std::vector<Eigen::Vector2d>& returns) {
  std::vector<Range> pieces;
  std::size_t start = 0;
  for (std::size_t i = 1; i <= returns.size(); ++i)
    if (i == returns.size() || areApart(returns[i - 1], returns[i])) {
      split(returns, {start, i}, pieces);
      start = i;
    }
  std::vector<ScanWall> walls;
  for (const Range& piece : pieces)
    if (const auto wall = fitWall(returns, piece)) walls.push_back(*wall);
  return walls;
}

std::vector<Eigen::Vector2d> horizontalReturns(const Scan& scan) {
  const Pose2 lidar_from_robot = planarPart(scan.robot_from_lidar).inverse();
  std::vector<Eigen::Vector2d> out;
  for (const auto& point : scan.pointsInRobot())
    out.push_back(lidar_from_robot * Eigen::Vector2d(point.head<2>()));
  return out;
}

}  // namespace roomgraph
