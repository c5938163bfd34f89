// SPDX-License-Identifier: BSD-3-Clause
// Boxes as a Poisson process: one source of boxes for each landmark in view, and clutter.
#include "box_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roomgraph/geometry/box_sides.h"
#include "roomgraph/geometry/projection.h"

namespace roomgraph {
namespace {

constexpr double kFade = 0.2;           ///< of far_m: how far before it objects begin to be missed
constexpr float kOccupied = 0.35F;      ///< cells less probably free than this hide what is behind
constexpr double kBehindFront_m = 0.3;  ///< how far in an object's own cells reach beyond its shape
constexpr double kCutShare = 0.5;       ///< of the sides that may be anywhere, those on the image border

double normalDensity(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma)) / (std::sqrt(2 * std::numbers::pi) * sigma);
}

double normalBelow(double x, double sigma) {
  return std::erfc(-x / (sigma * std::numbers::sqrt2)) / 2;
}

// Density of a side that may be anywhere on its axis, or its probability to be cut.
double anywhere(bool inside, double size_px) {
  return inside ? (1 - kCutShare) / (size_px - kImageBorder_px) : kCutShare;
}

std::array<double, 4> inOrder(const Box2& box) {
  return {box.u_min, box.v_min, box.u_max, box.v_max};
}

// Standard deviations of the sides: of the detector, and of the landmark's place by way of the projection's
// derivative for a point of the side at the depth of the landmark's middle.
Eigen::Array4d sideSigmas(const Landmark& landmark, const Box2& bounds, const Pose3& world_from_camera,
                          double depth, const PinholeCamera& camera, const MapLikelihoodOptions& options) {
  const Eigen::Matrix3d turn = world_from_camera.linear();
  const Eigen::Matrix3d covariance = turn.transpose() * landmark.covariance.topLeftCorner<3, 3>() * turn;
  const auto sides = inOrder(bounds);
  Eigen::Array4d sigma;
  for (int side = 0; side < 4; ++side) {
    const bool horizontal = side % 2 == 0;
    const double focal = horizontal ? camera.fx : camera.fy, principal = horizontal ? camera.cx : camera.cy;
    Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
    derivative[horizontal ? 0 : 1] = focal / depth;
    derivative[2] = -(sides[static_cast<std::size_t>(side)] - principal) / depth;
    const double detector = options.box_sigma * (horizontal ? bounds.width() : bounds.height());
    sigma[side] = std::sqrt(options.side_sigma_px * options.side_sigma_px + detector * detector +
                            std::max(0.0, derivative.dot(covariance * derivative)));
  }
  return sigma;
}

double shareInRange(double distance, const MapLikelihoodOptions& options) {
  if (distance < options.near_m || options.far_m <= 0) return 0;
  return std::clamp((options.far_m - distance) / (kFade * options.far_m), 0.0, 1.0);
}

double labelProbability(const std::string& class_name, const Landmark& landmark, int labels,
                        double wrong_label) {
  const auto at = landmark.class_posterior.find(class_name);
  const double posterior = at == landmark.class_posterior.end() ? 0 : at->second;
  return (1 - wrong_label) * posterior + wrong_label / labels;
}

}  // namespace

bool clearView(const mrpt::maps::COccupancyGridMap2D& grid, const Eigen::Vector2d& from,
               const Eigen::Vector2d& to, double reach_m) {
  const double distance = (to - from).norm() - reach_m;
  if (distance <= 0) return true;
  const double step = static_cast<double>(grid.getResolution());
  const Eigen::Vector2d direction = (to - from).normalized();
  for (double along = step; along < distance; along += step) {
    const Eigen::Vector2d at = from + along * direction;
    if (grid.getPos(static_cast<float>(at.x()), static_cast<float>(at.y())) < kOccupied) return false;
  }
  return true;
}

std::vector<ExpectedBox> expectedBoxes(const std::vector<Landmark>& landmarks,
                                       const mrpt::maps::COccupancyGridMap2D* grid,
                                       const Pose3& world_from_camera, const PinholeCamera& camera,
                                       const MapLikelihoodOptions& options) {
  const Pose3 camera_from_world = world_from_camera.inverse();
  const Eigen::Vector2d eye = world_from_camera.translation().head<2>();
  std::vector<ExpectedBox> out;
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector2d place = landmark.position.head<2>();
    const double in_range = shareInRange((place - eye).norm(), options);
    if (in_range <= 0) continue;
    const Pose3 camera_from_object = camera_from_world * landmark.worldFromObject();
    const auto projected = projectShape(landmark.shape, camera_from_object, camera);
    const double depth = (camera_from_object * Eigen::Vector3d(0, 0, landmark.shape.height / 2)).z();
    if (!projected || projected->full.empty() || depth < options.near_m) continue;
    double count = options.detection_probability * landmark.existence * in_range * projected->visible.area() /
                   projected->full.area();
    const double reach = landmark.shape.horizontalExtent() / 2 + kBehindFront_m;
    if (grid && !clearView(*grid, eye, place, reach)) count *= options.behind_walls;
    out.push_back({&landmark, projected->full,
                   sideSigmas(landmark, projected->full, world_from_camera, depth, camera, options), count});
  }
  return out;
}

double boxDensityOf(const Box2& box, const ExpectedBox& expected, const PinholeCamera& camera,
                    double hidden_side) {
  const auto inside = sidesInside(box, camera).inOrder();
  const auto measured = inOrder(box), predicted = inOrder(expected.bounds);
  double density = 1;
  for (std::size_t side = 0; side < 4; ++side) {
    const double size = side % 2 == 0 ? camera.width : camera.height;
    const double sigma = expected.sigma[static_cast<Eigen::Index>(side)];
    const double beyond =
        side < 2 ? kImageBorder_px - predicted[side] : predicted[side] - (size - kImageBorder_px);
    const double seen =
        inside[side] ? normalDensity(measured[side] - predicted[side], sigma) : normalBelow(beyond, sigma);
    density *= (1 - hidden_side) * seen + hidden_side * anywhere(inside[side], size);
  }
  return density;
}

double clutterDensity(const Box2& box, const PinholeCamera& camera) {
  const auto inside = sidesInside(box, camera).inOrder();
  double density = 1;
  for (std::size_t side = 0; side < 4; ++side)
    density *= anywhere(inside[side], side % 2 == 0 ? camera.width : camera.height);
  return density;
}

double logLikelihoodOf(const std::vector<ClassBox>& boxes, const std::vector<ExpectedBox>& expected,
                       const PinholeCamera& camera, int labels, const MapLikelihoodOptions& options) {
  double sum = 0;
  for (const ExpectedBox& landmark : expected) sum -= landmark.count;
  for (const ClassBox& seen : boxes) {
    double intensity = options.clutter_boxes / labels * clutterDensity(seen.box, camera);
    for (const ExpectedBox& landmark : expected)
      intensity += landmark.count *
                   labelProbability(seen.class_name, *landmark.landmark, labels, options.wrong_label) *
                   boxDensityOf(seen.box, landmark, camera, options.hidden_side);
    sum += std::log(intensity);
  }
  return sum;
}

}  // namespace roomgraph
