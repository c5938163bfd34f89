// SPDX-License-Identifier: BSD-3-Clause
// Floor plane by sampled surface normals, test for points below, and refinement on inliers.
#include "floor_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "roomgraph/geometry/degree.h"

namespace roomgraph {
namespace {

constexpr int kNormalReach = 2;  // grid points to each side over which the surface's direction is taken
constexpr int kTries = 200;
constexpr double kThickness = 0.015;                // of the plane, share of the range
constexpr double kBelow = 0.06, kMostBelow = 0.04;  // what counts as below, and the share that may lie there
constexpr double kLeastShare = 0.08;                // of the measured points on the floor
constexpr std::size_t kLeastPoints = 100;
const double kUpGate = std::cos(30 * kDegree), kNormalGate = std::cos(20 * kDegree);

struct Sample {
  Eigen::Vector3d point, normal;
};

// Direction of the surface at a grid position, towards the sensor; zero at borders and next to holes.
Eigen::Vector3d normalAt(const PointGrid& grid, int column, int row, int rows) {
  const auto at = [&](int c, int r) { return grid.points[static_cast<std::size_t>(r * grid.columns + c)]; };
  if (column < kNormalReach || row < kNormalReach || column + kNormalReach >= grid.columns ||
      row + kNormalReach >= rows)
    return Eigen::Vector3d::Zero();
  const Eigen::Vector3d left = at(column - kNormalReach, row), right = at(column + kNormalReach, row),
                        above = at(column, row - kNormalReach), below = at(column, row + kNormalReach);
  if (left.isZero() || right.isZero() || above.isZero() || below.isZero()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = (right - left).cross(below - above).normalized();
  return normal.dot(at(column, row)) > 0 ? Eigen::Vector3d(-normal) : normal;
}

std::vector<Sample> samplesOf(const PointGrid& grid) {
  std::vector<Sample> samples;
  const int rows = grid.columns == 0 ? 0 : static_cast<int>(grid.points.size()) / grid.columns;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto& point = grid.points[static_cast<std::size_t>(row * grid.columns + column)];
      if (!point.isZero()) samples.push_back({point, normalAt(grid, column, row, rows)});
    }
  return samples;
}

Plane planeThrough(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return {normal, -normal.dot(point)};
}

std::vector<Eigen::Vector3d> near(const Plane& plane, const std::vector<Sample>& candidates) {
  std::vector<Eigen::Vector3d> points;
  for (const Sample& s : candidates)
    if (std::abs(plane.distance(s.point)) < kThickness * s.point.norm() &&
        s.normal.dot(plane.normal) > kNormalGate)
      points.push_back(s.point);
  return points;
}

bool hasMuchBelow(const Plane& plane, const std::vector<Sample>& samples) {
  const auto below = std::count_if(samples.begin(), samples.end(), [&](const Sample& s) {
    return plane.distance(s.point) < -kBelow * s.point.norm();
  });
  return static_cast<double>(below) > kMostBelow * static_cast<double>(samples.size());
}

Plane fitted(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  return planeThrough(mean, normal.dot(up) < 0 ? Eigen::Vector3d(-normal) : normal);
}

}  // namespace

std::optional<Plane> findFloor(const PointGrid& grid, const Eigen::Vector3d& up) {
  const std::vector<Sample> samples = samplesOf(grid);
  std::vector<Sample> candidates;
  for (const Sample& s : samples)
    if (s.normal.dot(up) > kUpGate) candidates.push_back(s);
  const std::size_t least =
      std::max(kLeastPoints, static_cast<std::size_t>(kLeastShare * static_cast<double>(samples.size())));
  if (candidates.size() < least) return std::nullopt;
  std::mt19937 random(1);
  std::optional<Plane> best;
  std::size_t most = least - 1;
  for (int i = 0; i < kTries; ++i) {
    const auto pick = [&] { return candidates[random() % candidates.size()].point; };
    const Eigen::Vector3d a = pick(), normal = (pick() - a).cross(pick() - a).normalized();
    const Plane plane = planeThrough(a, normal.dot(up) < 0 ? Eigen::Vector3d(-normal) : normal);
    if (!(plane.normal.dot(up) > kUpGate) || plane.offset <= 0) continue;  // also when the three are in line
    const std::size_t count = near(plane, candidates).size();
    if (count <= most || hasMuchBelow(plane, samples)) continue;
    most = count;
    best = plane;
  }
  for (int i = 0; best && i < 3; ++i) {
    const auto inliers = near(*best, candidates);
    if (inliers.size() < least) return std::nullopt;
    best = fitted(inliers, up);
  }
  return best;
}

}  // namespace roomgraph
