// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/proposals/ground_plane.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/proposals/plane_fit.h"

namespace roomgraph {
namespace {

constexpr int kStride = 8;           // px between the sampled points
constexpr int kCountStride = 3;      // every third of them is enough to compare hypotheses
constexpr double kMinSpread = 0.12;  // m; a strip narrower than this does not fix a plane
const Eigen::Vector3d kImageUp(0, -1, 0);

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

double tolerance(const Eigen::Vector3d& p) {
  return 0.012 + 3 * depthSigma(p.z());
}

std::vector<Eigen::Vector3d> samplePoints(const Frame& frame, double max_range) {
  std::vector<Eigen::Vector3d> points;
  for (int v = kStride / 2; v < frame.depth.rows; v += kStride)
    for (int u = kStride / 2; u < frame.depth.cols; u += kStride) {
      const float z = frame.depth.at<float>(v, u);
      if (z > 0 && z < max_range) points.push_back(frame.camera.backProject(u, v, z));  // false for NaN
    }
  return points;
}

bool plausible(const Plane& plane, const std::optional<Plane>& expected, const GroundSearch& search) {
  if (expected)
    return angleBetween(plane.normal, expected->normal) <= search.max_angle_error &&
           std::abs(plane.offset - expected->offset) <= search.max_height_error_m;
  return angleBetween(plane.normal, kImageUp) <= search.max_tilt &&
         plane.offset >= search.min_camera_height_m && plane.offset <= search.max_camera_height_m;
}

// Share of points clearly below: a floor has nothing under it, a table has.
double ratioBelow(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  const auto below = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return plane.distance(p) < -(0.05 + 3 * tolerance(p));
  });
  return static_cast<double>(below) / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

// Points that may be floor: near the expected one, or anything in the lower part of the view.
std::vector<Eigen::Vector3d> candidates(const std::vector<Eigen::Vector3d>& points,
                                        const std::optional<Plane>& expected, const GroundSearch& search) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& p : points) {
    const double distance = expected ? std::abs(expected->distance(p)) : 0;
    if (!expected || distance <= search.max_height_error_m + p.norm() * search.max_angle_error)
      out.push_back(p);
  }
  return out;
}

std::optional<Plane> hypothesis(const std::vector<Eigen::Vector3d>& points,
                                const std::vector<Eigen::Vector3d>& near,
                                const std::optional<Plane>& expected, const GroundSearch& search) {
  std::vector<Eigen::Vector3d> few;
  for (std::size_t i = 0; i < near.size(); i += kCountStride) few.push_back(near[i]);
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < points.size(); i += kCountStride) all.push_back(points[i]);
  return bestPlane(few, expected ? 80 : 400, [&](const Plane& plane) {
    if (!plausible(plane, expected, search)) return 0;
    const auto inliers = std::count_if(few.begin(), few.end(), [&](const Eigen::Vector3d& p) {
      return std::abs(plane.distance(p)) < tolerance(p);
    });
    return ratioBelow(plane, all) <= search.max_below_ratio ? static_cast<int>(inliers) : 0;
  });
}

}  // namespace

Outcome<GroundEstimate> findGround(const Frame& frame, const std::optional<Plane>& expected,
                                   const GroundSearch& search) {
  using Result = Outcome<GroundEstimate>;
  if (!frame.hasDepth()) return Result::failure("no depth image");
  const auto points = samplePoints(frame, search.max_range_m);
  const auto near = candidates(points, expected, search);
  if (static_cast<int>(near.size()) < search.min_points)
    return Result::failure("no floor in view: too few points");
  const auto initial = hypothesis(points, near, expected, search);
  if (!initial)
    return Result::failure(expected ? "no plane near the expected floor"
                                    : "no plane below the camera can be the floor");
  const RefinedPlane refined = refinePlane(*initial, near);
  if (refined.inliers < search.min_points) return Result::failure("too few floor points");
  if (refined.spread_m < kMinSpread) return Result::failure("the visible floor is too narrow");
  if (!plausible(refined.plane, expected, search))
    return Result::failure("the plane disagrees with the expected floor");
  if (ratioBelow(refined.plane, points) > search.max_below_ratio)
    return Result::failure("too many points lie below the plane");
  return GroundEstimate{refined.plane, refined.covariance, true};
}

}  // namespace roomgraph
