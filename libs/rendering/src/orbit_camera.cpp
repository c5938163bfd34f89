// SPDX-License-Identifier: BSD-3-Clause
// Axes of the camera, projection and its inverse, alternating fit.
#include "roomgraph/rendering/orbit_camera.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/degree.h"

namespace roomgraph {

OrbitCamera::Axes OrbitCamera::axes() const {
  Axes out;
  out.forward = {-std::cos(azimuth) * std::cos(elevation), -std::sin(azimuth) * std::cos(elevation),
                 -std::sin(elevation)};
  out.right = {-std::sin(azimuth), std::cos(azimuth), 0};
  out.up = out.right.cross(out.forward);
  out.eye = target - distance * out.forward;
  const double aspect = static_cast<double>(width) / height;
  out.half_height = orthographic ? distance / 4 / std::min(aspect, 1.0) : std::tan(field_of_view / 2);
  out.half_width = out.half_height * aspect;
  return out;
}

std::optional<Eigen::Vector2d> OrbitCamera::project(const Eigen::Vector3d& world) const {
  const Axes view = axes();
  const Eigen::Vector3d from_eye = world - view.eye;
  const double depth = orthographic ? 1 : view.forward.dot(from_eye);
  if (depth <= 1e-6) return std::nullopt;
  const double x = view.right.dot(from_eye) / (view.half_width * depth);
  const double y = view.up.dot(from_eye) / (view.half_height * depth);
  return Eigen::Vector2d((x + 1) / 2 * width, (1 - y) / 2 * height);
}

OrbitCamera::Ray OrbitCamera::rayThrough(const Eigen::Vector2d& pixel) const {
  const Axes view = axes();
  const Eigen::Vector3d aside = (2 * pixel.x() / width - 1) * view.half_width * view.right +
                                (1 - 2 * pixel.y() / height) * view.half_height * view.up;
  if (orthographic) return {view.eye + aside, view.forward};
  return {view.eye, (view.forward + aside).normalized()};
}

double OrbitCamera::pixelsPerMeter() const {
  return (*project(Eigen::Vector3d::UnitX()) - *project(Eigen::Vector3d::Zero())).norm();
}

/// Moves the target on the floor so that the picture moves by so many pixels.
void OrbitCamera::shift(const Eigen::Vector2d& pixels) {
  target.z() = 0;
  const double step = 0.01;
  const auto here = project(target), x = project(target + Eigen::Vector3d(step, 0, 0)),
             y = project(target + Eigen::Vector3d(0, step, 0));
  if (!here || !x || !y) return;
  Eigen::Matrix2d pixels_from_floor;
  pixels_from_floor << (*x - *here) / step, (*y - *here) / step;
  target.head<2>() -= pixels_from_floor.inverse() * pixels;
}

void OrbitCamera::fit(const std::vector<Eigen::Vector3d>& content, const Box2& inner) {
  for (int round = 0; round < 20; ++round) {
    Eigen::AlignedBox2d image;
    for (const auto& point : content)
      if (const auto pixel = project(point)) image.extend(*pixel);
    if (image.isEmpty()) return;
    shift(inner.center() - image.center());
    distance *= std::max(image.sizes().x() / inner.width(), image.sizes().y() / inner.height());
  }
}

void OrbitCamera::applyTo(mrpt::opengl::CCamera& camera) const {
  if (orthographic)
    camera.setOrthogonal();
  else
    camera.setProjectiveFOVdeg(static_cast<float>(field_of_view * kDegreesPerRadian));
  camera.setPointingAt(static_cast<float>(target.x()), static_cast<float>(target.y()),
                       static_cast<float>(target.z()));
  camera.setZoomDistance(static_cast<float>(distance));
  camera.setAzimuthDegrees(static_cast<float>(azimuth * kDegreesPerRadian));
  camera.setElevationDegrees(static_cast<float>(elevation * kDegreesPerRadian));
}

OrbitCamera behindRobot(const Pose3& world_from_robot, int width, int height) {
  OrbitCamera camera{.distance = 6.5,
                     .azimuth = planarPart(world_from_robot).yaw + M_PI,
                     .elevation = 32 * kDegree,
                     .field_of_view = 55 * kDegree,
                     .width = width,
                     .height = height};
  camera.target << (world_from_robot * Eigen::Vector3d(1.2, 0, 0)).head<2>(), 0.5;
  return camera;
}

}  // namespace roomgraph
