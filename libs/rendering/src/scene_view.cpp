// SPDX-License-Identifier: BSD-3-Clause
// Fit of the camera to the map's content, and projection into pixels.
#include "scene_view.h"

#include <mrpt/opengl/COpenGLViewport.h>

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/degree.h"
#include "scene_parts.h"

namespace roomgraph {
namespace {

/// Points around everything that the picture must show: the ends of every row of known cells, objects, path.
/// A tighter fit than the corners of the bounding box when the rooms lie askew.
std::vector<Eigen::Vector3d> contentPoints(const CSemanticMap& map) {
  std::vector<Eigen::Vector3d> points;
  if (map.occupancy) {
    const auto& grid = *map.occupancy;
    const int width = static_cast<int>(grid.getSizeX());
    for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y) {
      int first = 0, last = width - 1;
      while (first < width && !isKnown(grid.getCell(first, y))) ++first;
      while (last > first && !isKnown(grid.getCell(last, y))) --last;
      if (first == width) continue;
      for (const int x : {first, last})
        points.emplace_back(static_cast<double>(grid.idx2x(static_cast<std::size_t>(x))),
                            static_cast<double>(grid.idx2y(static_cast<std::size_t>(y))), 0);
    }
  }
  for (const auto& landmark : map.landmarks)
    for (const auto& corner : footprintInWorld(landmark))
      for (const double height : {0.0, landmark.shape.height})
        points.push_back(corner + Eigen::Vector3d(0, 0, height));
  for (const auto& stamped : map.world_from_robot) points.push_back(stamped.pose.translation());
  const Eigen::AlignedBox3d box = contentBounds(map);
  if (points.size() < 3 || !map.occupancy) points.insert(points.end(), {box.min(), box.max()});
  return points;
}

}  // namespace

SceneView::SceneView(mrpt::opengl::COpenGLScene& scene, const CSemanticMap& map,
                     const SnapshotOptions& options, const Box2& inner)
    : viewport_(scene.getViewport()), width_(options.width), height_(options.height) {
  const Eigen::AlignedBox3d box = contentBounds(map);
  const double extent = contentExtent(map);
  viewport_->setViewportClipDistances(0.1f, static_cast<float>(10 * extent + 100));
  const Eigen::Vector3d center = box.center();
  camera_.setPointingAt(static_cast<float>(center.x()), static_cast<float>(center.y()), 0);
  camera_.setZoomDistance(static_cast<float>(std::max(2 * extent, 5.0)));
  if (options.view == SnapshotView::kTop) {
    camera_.setOrthogonal();
    camera_.setAzimuthDegrees(-90);
    camera_.setElevationDegrees(90);
    fit(contentPoints(map), inner);
  } else if (options.view == SnapshotView::kOrbit || map.world_from_robot.empty()) {
    camera_.setProjectiveFOVdeg(30);
    camera_.setAzimuthDegrees(-65);
    camera_.setElevationDegrees(42);
    fit(contentPoints(map), inner);
  } else {
    const Pose3& last = map.world_from_robot.back().pose;
    const Eigen::Vector3d ahead = last * Eigen::Vector3d(1.2, 0, 0);
    camera_.setProjectiveFOVdeg(55);
    camera_.setPointingAt(static_cast<float>(ahead.x()), static_cast<float>(ahead.y()), 0.5f);
    camera_.setAzimuthDegrees(static_cast<float>(planarPart(last).yaw * kDegreesPerRadian + 180));
    camera_.setElevationDegrees(32);
    camera_.setZoomDistance(6.5f);
    update();
  }
}

// MRPT's camera model in orbit mode; its own matrices exist only while it renders.
void SceneView::update() {
  viewport_->getCamera() = camera_;
  const double azimuth = static_cast<double>(camera_.getAzimuthDegrees()) / kDegreesPerRadian;
  const double elevation = static_cast<double>(camera_.getElevationDegrees()) / kDegreesPerRadian;
  const double distance = static_cast<double>(camera_.getZoomDistance());
  const Eigen::Vector3d forward(-std::cos(azimuth) * std::cos(elevation),
                                -std::sin(azimuth) * std::cos(elevation), -std::sin(elevation));
  const Eigen::Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0), up = right.cross(forward);
  const Eigen::Vector3d eye = Eigen::Vector3d(static_cast<double>(camera_.getPointingAtX()),
                                              static_cast<double>(camera_.getPointingAtY()),
                                              static_cast<double>(camera_.getPointingAtZ())) -
                              distance * forward;
  const double aspect = static_cast<double>(width_) / height_;
  // Half the picture's height: in metres (orthographic), or at depth 1 m (perspective).
  const double half =
      orthographic() ? distance / 4 / std::min(aspect, 1.0)
                     : std::tan(static_cast<double>(camera_.getProjectiveFOVdeg()) / kDegreesPerRadian / 2);
  clip_from_world_.setIdentity();
  clip_from_world_.row(0) << right.transpose() / (half * aspect), -right.dot(eye) / (half * aspect);
  clip_from_world_.row(1) << up.transpose() / half, -up.dot(eye) / half;
  clip_from_world_.row(2) << forward.transpose(), -forward.dot(eye);
  if (!orthographic()) clip_from_world_.row(3) = clip_from_world_.row(2);
}

std::optional<Eigen::Vector2d> SceneView::project(const Eigen::Vector3d& world) const {
  const Eigen::Vector4d clip = clip_from_world_ * world.homogeneous();
  if (clip.w() <= 1e-6) return std::nullopt;
  return Eigen::Vector2d((clip.x() / clip.w() + 1) / 2 * width_, (1 - clip.y() / clip.w()) / 2 * height_);
}

double SceneView::pixelsPerMeter() const {
  return (*project(Eigen::Vector3d::UnitX()) - *project(Eigen::Vector3d::Zero())).norm();
}

/// Moves what the camera points at on the floor so that the picture moves by so many pixels.
void SceneView::shift(const Eigen::Vector2d& pixels) {
  const Eigen::Vector3d at(static_cast<double>(camera_.getPointingAtX()),
                           static_cast<double>(camera_.getPointingAtY()), 0);
  const double step = 0.01;
  const auto here = project(at), x = project(at + Eigen::Vector3d(step, 0, 0)),
             y = project(at + Eigen::Vector3d(0, step, 0));
  if (!here || !x || !y) return;
  Eigen::Matrix2d pixels_from_floor;
  pixels_from_floor << (*x - *here) / step, (*y - *here) / step;
  const Eigen::Vector2d move = pixels_from_floor.inverse() * pixels;
  camera_.setPointingAt(static_cast<float>(at.x() - move.x()), static_cast<float>(at.y() - move.y()), 0);
}

/// Alternates zooming and shifting until the content's image fills `inner`.
void SceneView::fit(const std::vector<Eigen::Vector3d>& content, const Box2& inner) {
  for (int round = 0; round < 20; ++round) {
    update();
    Eigen::AlignedBox2d image;
    for (const auto& point : content)
      if (const auto pixel = project(point)) image.extend(*pixel);
    shift(inner.center() - image.center());
    update();
    const double ratio = std::max(image.sizes().x() / inner.width(), image.sizes().y() / inner.height());
    camera_.setZoomDistance(static_cast<float>(static_cast<double>(camera_.getZoomDistance()) * ratio));
  }
  update();
}

}  // namespace roomgraph
