// SPDX-License-Identifier: BSD-3-Clause
// Split-and-merge line extraction; lines by least squares of range errors.
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
constexpr double kLeastDistance_m = 1e-3, kMostGrazing = -1e-3;  // of lines; the latter in 1/m
constexpr int kFitSteps = 4;
constexpr double kMostF = 7;             // of two pieces that are one: 1 in 1000 by chance
constexpr double kLeastNoise_m = 0.001;  // of ranges

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

// A line m . x = -1 fitted to returns: least squares of range errors, as beams have no others. Distances to
// the line would turn it where the beams meet it at a slant, as errors then move returns along it, too.
struct BeamLine {
  Eigen::Vector2d m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< of m, for range errors of 1 m
  double squares = 0, count = 0;                          ///< of range errors: sum, number
  Range returns{};
};

Eigen::Vector2d lineThrough(const Points& p, const Range& r) {
  const auto count = static_cast<double>(r.second - r.first);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = r.first; i < r.second; ++i) mean += p[i] / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t i = r.first; i < r.second; ++i) scatter += (p[i] - mean) * (p[i] - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  const Eigen::Vector2d normal = axes.eigenvectors().col(0);
  const double distance = normal.dot(mean);
  return std::abs(distance) > kLeastDistance_m ? Eigen::Vector2d(-normal / distance)
                                               : Eigen::Vector2d::Zero();
}

std::optional<BeamLine> fitBeams(const Points& p, Range r) {
  r = {r.first + kLeftOut, r.second - kLeftOut};
  BeamLine out{lineThrough(p, r), {}, 0, static_cast<double>(r.second - r.first), r};
  for (int step = 0; step <= kFitSteps; ++step) {  // of Gauss and Newton; after the last, errors only
    out.information.setZero();
    out.squares = 0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (std::size_t i = r.first; i < r.second; ++i) {
      const double range = p[i].norm();
      const Eigen::Vector2d beam = p[i] / range;
      const double slope = out.m.dot(beam);
      if (!(slope < kMostGrazing)) return std::nullopt;  // this beam does not meet the line
      const double off = range + 1 / slope;
      const Eigen::Vector2d change = -beam / (slope * slope);
      out.information += change * change.transpose();
      gradient += change * off;
      out.squares += off * off;
    }
    if (step < kFitSteps) out.m -= out.information.ldlt().solve(gradient);
  }
  return out;
}

double squaresOf(const Points& p, const BeamLine& line, const Range& r) {
  double out = 0;
  for (std::size_t i = r.first; i < r.second; ++i) {
    const double range = p[i].norm();
    out += std::pow(range + range / line.m.dot(p[i]), 2);
  }
  return out;
}

// Noise alone splits walls, too: two pieces are one line when one explains the returns of both about as well
// as two do (F-test of two parameters). Returns between the pieces are not asked: they are where it was split
// because they are far off.
std::optional<BeamLine> merged(const Points& p, const BeamLine& a, const BeamLine& b) {
  const auto joint = fitBeams(p, {a.returns.first - kLeftOut, b.returns.second + kLeftOut});
  if (!joint) return std::nullopt;
  const double apart = a.squares + b.squares,
               together = squaresOf(p, *joint, a.returns) + squaresOf(p, *joint, b.returns);
  const double variance = std::max(apart / (a.count + b.count - 4), kLeastNoise_m * kLeastNoise_m);
  return together - apart < 2 * kMostF * variance ? joint : std::nullopt;
}

// The error of the line across itself is quadratic along it, and least where `middle_m` is.
std::optional<ScanWall> wallOf(const Points& p, const BeamLine& line) {
  ScanWall wall;
  const double size = line.m.norm();
  wall.normal = line.m / size;
  wall.along = {-wall.normal.y(), wall.normal.x()};
  wall.distance_m = -1 / size;
  wall.from_m = wall.to_m = wall.along.dot(p[line.returns.first]);
  for (std::size_t i = line.returns.first; i < line.returns.second; ++i) {
    wall.from_m = std::min(wall.from_m, wall.along.dot(p[i]));
    wall.to_m = std::max(wall.to_m, wall.along.dot(p[i]));
  }
  if (!(wall.to_m - wall.from_m >= kLeastLength_m)) return std::nullopt;
  const Eigen::Matrix2d covariance =
      line.information.inverse() * std::max(line.squares / (line.count - 2), 1e-12) / (size * size);
  const double curvature = wall.along.dot(covariance * wall.along);
  wall.middle_m = -wall.distance_m * wall.normal.dot(covariance * wall.along) / curvature;
  const Eigen::Vector2d best = wall.distance_m * wall.normal + wall.middle_m * wall.along;
  wall.sigma_m = std::sqrt(std::max(best.dot(covariance * best), 1e-18));
  wall.spread_m = wall.sigma_m / std::sqrt(curvature);
  return wall;
}

void addWalls(const Points& p, const std::vector<Range>& pieces, std::vector<ScanWall>& out) {
  std::vector<BeamLine> lines;
  for (const Range& piece : pieces) {
    auto line = fitBeams(p, piece);
    if (!line) continue;
    while (!lines.empty())
      if (auto joint = merged(p, lines.back(), *line)) {
        line = joint;
        lines.pop_back();
      } else {
        break;
      }
    lines.push_back(*line);
  }
  for (const BeamLine& line : lines)
    if (const auto wall = wallOf(p, line)) out.push_back(*wall);
}

}  // namespace

double ScanWall::sigmaAt(double along_m) const {
  return sigma_m * std::sqrt(1 + std::pow((along_m - middle_m) / spread_m, 2));
}

std::vector<ScanWall> findScanWalls(const std::vector<Eigen::Vector2d>& returns) {
  std::vector<ScanWall> walls;
  std::size_t start = 0;
  for (std::size_t i = 1; i <= returns.size(); ++i)
    if (i == returns.size() || areApart(returns[i - 1], returns[i])) {
      std::vector<Range> pieces;
      split(returns, {start, i}, pieces);
      addWalls(returns, pieces, walls);
      start = i;
    }
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
