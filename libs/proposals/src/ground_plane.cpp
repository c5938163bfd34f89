// SPDX-License-Identifier: BSD-3-Clause
// RANSAC over floor samples with surface normals and a test for points below the plane.
#include "ground_plane.h"

#include <algorithm>
#include <cmath>

#include "plane_fit.h"

namespace roomgraph {
namespace {

constexpr int kColumns = 80;          // of the grid of sampled points
constexpr double kSupportUnit = 100;  // integer support of a point exactly on the plane
constexpr int kCountStride = 3;       // every third sample is enough to compare hypotheses
constexpr int kNormalReach = 2;       // samples to each side from which the surface normal is computed
constexpr double kNormalGate = 0.30;  // rad, between the surface normal and the plane's
constexpr double kMostTilt = 1.5;     // rad; wider gates would admit walls
constexpr double kMinSpread = 0.12;   // m; a narrower strip does not determine a plane
// Inliers are this near to the plane: m, and a factor on the depth noise.
constexpr double kInlier_m = 0.012, kInlierPerNoise = 3;
// Points below the plane are farther from it than this: m, and a factor on the inliers' distance.
constexpr double kBelow_m = 0.05, kBelowPerInlier = 3;
// RANSAC: an expected plane leaves few of the points in question. Without one a small plane is not trusted.
constexpr int kTriesExpected = 80, kTriesUnknown = 400;
constexpr int kMorePointsUnknown = 2;
const Eigen::Vector3d kImageUp(0, -1, 0);

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

double tolerance(const Eigen::Vector3d& p) {
  return kInlier_m + kInlierPerNoise * depthSigma(p.z());
}

struct Sample {
  Eigen::Vector3d point, normal;  // normal towards the camera; zero: unknown
};

// Surface normal at a grid position from its neighbours (where one is missing, from itself); zero next to holes.
Eigen::Vector3d surfaceNormal(const std::vector<Eigen::Vector3d>& grid, int columns, int i) {
  const int column = i % columns, r = kNormalReach;
  const auto at = [&](int k, bool inside) {
    return inside && k >= 0 && k < static_cast<int>(grid.size()) && grid[k].z() > 0 ? grid[k] : grid[i];
  };
  const Eigen::Vector3d across = at(i + r, column + r < columns) - at(i - r, column >= r);
  const Eigen::Vector3d down = at(i + r * columns, true) - at(i - r * columns, true);
  if (across.isZero() || down.isZero()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = across.cross(down).normalized();
  return normal.dot(grid[i]) > 0 ? Eigen::Vector3d(-normal) : normal;
}

std::vector<Sample> sampleSurface(const Frame& frame, double max_range) {
  std::vector<Eigen::Vector3d> grid;
  const int stride = std::max(1, frame.depth.cols / kColumns);
  const int columns = (frame.depth.cols + stride - 1 - stride / 2) / stride;
  for (int v = stride / 2; v < frame.depth.rows; v += stride)
    for (int u = stride / 2; u < frame.depth.cols; u += stride) {
      const float z = frame.depth.at<float>(v, u);
      const bool good = z > 0 && z < max_range;  // false for NaN
      grid.push_back(good ? frame.camera.backProject(u, v, z) : Eigen::Vector3d::Zero());
    }
  std::vector<Sample> samples;
  for (int i = 0; i < static_cast<int>(grid.size()); ++i)
    if (grid[i].z() > 0) samples.push_back({grid[i], surfaceNormal(grid, columns, i)});
  return samples;
}

bool plausible(const Plane& plane, const std::optional<Plane>& expected, const GroundSearch& search) {
  if (expected)
    return angleBetween(plane.normal, expected->normal) <= search.max_angle_error_rad &&
           std::abs(plane.offset - expected->offset) <= search.max_height_error_m;
  return angleBetween(plane.normal, kImageUp) <= search.max_tilt_rad &&
         plane.offset >= search.min_camera_height_m && plane.offset <= search.max_camera_height_m;
}

// Share of points clearly below: a floor has nothing under it, a table has.
double ratioBelow(const Plane& plane, const std::vector<Sample>& samples) {
  const auto below = std::count_if(samples.begin(), samples.end(), [&](const Sample& s) {
    return plane.distance(s.point) < -(kBelow_m + kBelowPerInlier * tolerance(s.point));
  });
  return static_cast<double>(below) / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

// Samples that may be floor: with a normal that points up, and near the expected floor when there is one.
std::vector<Sample> candidates(const std::vector<Sample>& samples, const std::optional<Plane>& expected,
                               const GroundSearch& search) {
  std::vector<Sample> out;
  const Eigen::Vector3d up = expected ? expected->normal : kImageUp;
  const double least =
      std::cos(std::min(kMostTilt, kNormalGate + (expected ? search.max_angle_error_rad : search.max_tilt_rad)));
  for (const Sample& s : samples) {
    const double reach = search.max_height_error_m + s.point.norm() * search.max_angle_error_rad;
    if (s.normal.dot(up) >= least && (!expected || std::abs(expected->distance(s.point)) <= reach))
      out.push_back(s);
  }
  return out;
}

std::vector<Sample> thinned(const std::vector<Sample>& samples) {
  std::vector<Sample> few;
  for (std::size_t i = 0; i < samples.size(); i += kCountStride) few.push_back(samples[i]);
  return few;
}

std::vector<Eigen::Vector3d> pointsOf(const std::vector<Sample>& samples) {
  std::vector<Eigen::Vector3d> points;
  for (const Sample& s : samples) points.push_back(s.point);
  return points;
}

// Inliers have the plane's normal, so that a plane that merely cuts through clutter has few.
std::optional<Plane> hypothesis(const std::vector<Sample>& samples, const std::vector<Sample>& near,
                                const std::optional<Plane>& expected, const GroundSearch& search) {
  const std::vector<Sample> few = thinned(near), all = thinned(samples);
  const double least = std::cos(kNormalGate);
  return bestPlane(pointsOf(few), expected ? kTriesExpected : kTriesUnknown, [&](const Plane& plane) {
    if (!plausible(plane, expected, search)) return 0;
    if (ratioBelow(plane, all) > search.max_below_ratio) return 0;
    double support = 0;  // points near the plane count more: a slanted plane between floor and step must not win
    for (const Sample& s : few) {
      const double r = plane.distance(s.point) / tolerance(s.point);
      if (std::abs(r) < 1 && s.normal.dot(plane.normal) > least) support += 1 - r * r;
    }
    return static_cast<int>(kSupportUnit * support);
  });
}

}  // namespace

Outcome<GroundEstimate> findGround(const Frame& frame, const std::optional<Plane>& expected,
                                   const GroundSearch& search) {
  using Result = Outcome<GroundEstimate>;
  if (!frame.hasDepth()) return Result::failure("no depth image");
  const auto samples = sampleSurface(frame, search.max_range_m);
  const auto near = candidates(samples, expected, search);
  if (static_cast<int>(near.size()) < search.min_points)
    return Result::failure("no floor in view: too few points");
  const auto initial = hypothesis(samples, near, expected, search);
  if (!initial)
    return Result::failure(expected ? "no plane near the expected floor"
                                    : "no plane below the camera can be the floor");
  const RefinedPlane refined = refinePlane(*initial, pointsOf(near));
  if (refined.inliers < (expected ? 1 : kMorePointsUnknown) * search.min_points)
    return Result::failure("too few floor points");
  if (refined.spread_m < kMinSpread) return Result::failure("the visible floor is too narrow");
  if (!plausible(refined.plane, expected, search))
    return Result::failure("the plane disagrees with the expected floor");
  if (ratioBelow(refined.plane, samples) > search.max_below_ratio)
    return Result::failure("too many points lie below the plane");
  return GroundEstimate{refined.plane, refined.covariance, true};
}

}  // namespace roomgraph
