// SPDX-License-Identifier: BSD-3-Clause
// Ranges of door sides, directions of level segments, and doors from both.
#include "door_from_image.h"

#include <algorithm>
#include <cmath>

#include "door_on_plane.h"

namespace roomgraph {
namespace {

constexpr double kLeastTilt = 0.003;      // rad, standard deviation of a measured ground normal
constexpr double kLeastSlope = 0.02;      // of a ray against the horizon; flatter ones tell no range
constexpr double kLeastRise_m = 0.1;    // of a point above or below the camera, for the same reason
constexpr double kSegment_px = 1.5;       // standard deviation of a segment's ends in the reduced image
constexpr double kLevelFloor = 0.03;      // rad, least standard deviation of a segment's direction
constexpr double kVagueLevel = 0.35;      // rad, the largest that is used
constexpr double kWidthDirection = 0.35;  // rad, standard deviation of a direction that the usual width gives
constexpr std::size_t kMostDirections = 5;    // the most accurate ones are tried
constexpr double kSteepSegment = 0.15;    // horizontal by vertical extent, of a line that is vertical in space
// Segment taken for the door frame's edge: its least length, by the box's height, and its largest distance from the
// box's side, by the box's width.
constexpr double kFrameLength = 0.3, kFrameDistance = 0.12;
constexpr double kNearerSlack = 0.98;  // ratio of the ranges from which the other side counts as the farther one

Eigen::Vector3d rayInGround(const BoxEvidence& e, double u, double v) {
  return e.camera_from_ground.linear().transpose() * e.camera.ray(u, v);
}

// Range of a point `height` above or below the camera, m, seen at a slope; both sigmas are standard deviations.
std::optional<Measured> rangeOf(double height, double slope, double angle_sigma, double height_sigma) {
  if (height <= kLeastRise_m || slope < kLeastSlope) return std::nullopt;
  const double range = height / slope;
  if (range > kFarthestGround_m) return std::nullopt;
  return Measured{range, std::hypot(range * (slope + 1 / slope) * angle_sigma, height_sigma / slope)};
}

// Column of the door frame's edge near a side of the box: that of the longest steep segment; else of the side itself.
double frameEdge(const BoxEvidence& e, double side) {
  for (const Segment2& s : e.segments) {  // longest first
    const Eigen::Vector2d along = s.b - s.a;
    if (std::abs(along.x()) < kSteepSegment * std::abs(along.y()) &&
        along.norm() > kFrameLength * e.box.height() &&
        std::abs((s.a.x() + s.b.x()) / 2 - side) < kFrameDistance * e.box.width())
      return (s.a.x() + s.b.x()) / 2;
  }
  return side;
}

// The nearer side of a door, and the direction in which the other side of the box is seen.
struct Sides {
  Eigen::Vector2d near = Eigen::Vector2d::Zero();  ///< ground frame
  Eigen::Vector2d far = Eigen::Vector2d::Zero();   ///< unit direction to the other side
  double sigma = 0;                                ///< of the nearer side's range
};

std::vector<Sides> sidesOf(const BoxEvidence& e) {
  std::vector<Sides> out;
  for (const auto& [near_u, far_u] :
       {std::pair{e.box.u_min, e.box.u_max}, std::pair{e.box.u_max, e.box.u_min}}) {
    const auto range = sideRange(e, near_u);
    if (!range) continue;
    const double v = e.box.center().y();
    out.push_back({range->value * rayInGround(e, near_u, v).head<2>().normalized(),
                   rayInGround(e, far_u, v).head<2>().normalized(), range->sigma});
  }
  return out;
}

std::optional<PlacedShape> through(const Sides& sides, const Eigen::Vector2d& direction, double angle_sigma,
                                   const std::string& source, const BoxEvidence& e) {
  VerticalPlane plane = planeThrough(sides.near, sides.near + direction);
  plane.middle = plane.along().dot(sides.near);
  plane.sigma_m = sides.sigma * std::abs(plane.normal.dot(sides.near.normalized()));
  plane.sigma_rad = angle_sigma;
  plane.inlier_share = 1;
  auto placed = doorOnPlane(plane, e, e.model->depth_m / 4);
  if (placed) placed->source = source;
  return placed;
}

// Whether a door from the nearer side in this direction ends, in line with the other side, farther from the camera.
bool goesAway(const Sides& sides, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  const double across = normal.dot(sides.far);
  return std::abs(across) > 1e-3 && normal.dot(sides.near) / across >= sides.near.norm();
}

void addLevelLines(const std::vector<Sides>& sides, const BoxEvidence& e, std::vector<PlacedShape>& out) {
  std::vector<Measured> directions;
  for (const Segment2& s : e.segments)
    if (const auto direction = levelDirection(s, e, kSegment_px / e.edges.scale))
      directions.push_back(*direction);
  std::stable_sort(directions.begin(), directions.end(),
                   [](const Measured& a, const Measured& b) { return a.sigma < b.sigma; });
  if (directions.size() > kMostDirections) directions.resize(kMostDirections);
  for (const Measured& direction : directions)
    for (const Sides& s : sides) {
      const Eigen::Vector2d d(std::cos(direction.value), std::sin(direction.value));
      if (!goesAway(s, d)) continue;
      if (auto placed = through(s, d, direction.sigma, "level lines", e)) out.push_back(std::move(*placed));
    }
}

// The sides are the usual width apart: |s far - near| = width has up to two solutions.
void addUsualWidth(const std::vector<Sides>& sides, const BoxEvidence& e, std::vector<PlacedShape>& out) {
  if (e.cut.left || e.cut.right) return;
  const double width = e.model->width_m;
  for (const Sides& side : sides) {
    const double middle = side.far.dot(side.near);
    const double root = width * width - side.near.squaredNorm() + middle * middle;
    if (root < 0) continue;
    for (const double s : {middle - std::sqrt(root), middle + std::sqrt(root)}) {
      if (s < kNearerSlack * side.near.norm()) continue;
      const Eigen::Vector2d direction = (s * side.far - side.near).normalized();
      if (auto placed = through(side, direction, kWidthDirection, "usual width", e))
        out.push_back(std::move(*placed));
    }
  }
}

// Only the range is known: the door faces the camera.
void addFacing(const std::vector<Sides>& sides, const BoxEvidence& e, std::vector<PlacedShape>& out) {
  if (sides.empty()) return;
  Sides middle = sides.front();
  middle.near =
      middle.near.norm() * rayInGround(e, e.box.center().x(), e.box.center().y()).head<2>().normalized();
  const Eigen::Vector2d across(-middle.near.y(), middle.near.x());
  if (auto placed = through(middle, across, kWidthDirection, "facing the camera", e)) {
    placed->has_yaw = false;
    out.push_back(std::move(*placed));
  }
}

}  // namespace

std::optional<Measured> sideRange(const BoxEvidence& e, double u) {
  const double tilt = std::max(kLeastTilt, e.ground_tilt_sigma), height = e.ground.offset;
  const double angle = std::hypot(sideSigma(e.box.height()) / e.camera.fy, tilt);
  const auto slope = [&](double v) {
    const Eigen::Vector3d ray = rayInGround(e, u, v);
    return ray.z() / ray.head<2>().norm();
  };
  std::optional<Measured> bottom, top;
  if (!e.cut.bottom) bottom = rangeOf(height, -slope(e.box.v_max), angle, 0);
  if (!e.cut.top)
    top = rangeOf(e.model->height_m - height, slope(e.box.v_min), angle, e.model->sizeSigma()[2]);
  if (!bottom || !top) return bottom ? bottom : top;
  const double a = std::pow(bottom->sigma, -2), b = std::pow(top->sigma, -2);
  return Measured{(a * bottom->value + b * top->value) / (a + b), std::sqrt(1 / (a + b))};
}

std::optional<Measured> levelDirection(const Segment2& s, const BoxEvidence& e, double pixel) {
  const Eigen::Vector2d along = s.b - s.a;
  if (std::abs(along.x()) < kSteepSegment * std::abs(along.y())) return std::nullopt;
  const Eigen::Vector3d a = rayInGround(e, s.a.x(), s.a.y()), b = rayInGround(e, s.b.x(), s.b.y());
  const Eigen::Vector3d normal = a.cross(b).normalized();
  const double level = normal.head<2>().norm();  // 0: the segment lies on the horizon
  const double sigma = pixel / along.norm() / std::max(level, 1e-6);
  if (sigma > kVagueLevel) return std::nullopt;
  return Measured{std::atan2(-normal.x(), normal.y()), std::hypot(sigma, kLevelFloor)};
}

std::vector<PlacedShape> doorsFromImage(const BoxEvidence& evidence) {
  BoxEvidence e = evidence;
  if (!e.cut.left) e.box.u_min = frameEdge(evidence, evidence.box.u_min);
  if (!e.cut.right) e.box.u_max = frameEdge(evidence, evidence.box.u_max);
  const auto sides = sidesOf(e);
  std::vector<PlacedShape> out;
  addLevelLines(sides, e, out);
  addUsualWidth(sides, e, out);
  addFacing(sides, e, out);
  return out;
}

}  // namespace roomgraph
