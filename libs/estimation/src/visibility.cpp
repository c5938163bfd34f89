// SPDX-License-Identifier: BSD-3-Clause
// Visibility test by projection and depth; beams that end in or pass through a footprint.
#include "visibility.h"

#include <algorithm>
#include <cmath>

#include "roomgraph/geometry/projection.h"

namespace roomgraph {
namespace {

constexpr double kMinHeightShare = 0.104;  // of the image
constexpr double kMinShareInImage = 0.7, kNear_m = 1.0, kFar_m = 4.0, kMaxHidden = 0.3;
constexpr double kMiddle = 0.5;  // share of the footprint's smaller half that the covariance cannot reach
constexpr double kSamePlace =
    0.3;  // IoU with a detection, of whatever label, that shows that something is there

// Share of the depth pixels in the middle of the box that lie clearly in front of the object.
double hiddenShare(const DepthLookup& depth_at, const Box2& box, double distance_m, double margin_m) {
  int seen = 0, hidden = 0;
  constexpr int kSteps = 12;
  for (int i = 1; i < kSteps; ++i) {
    for (int j = 1; j < kSteps; ++j) {
      const double z = depth_at(box.u_min + box.width() * i / kSteps, box.v_min + box.height() * j / kSteps);
      if (z <= 0) continue;
      ++seen;
      hidden += z < distance_m - margin_m;
    }
  }
  return seen > 0 ? static_cast<double>(hidden) / seen : 1.0;
}

}  // namespace

std::optional<Box2> boxInGoodView(const Landmark& landmark, const Pose3& camera_from_world,
                                  const PinholeCamera& camera, const DepthLookup& depth_at) {
  const Pose3 camera_from_object = camera_from_world * landmark.worldFromObject();
  const double distance = (camera_from_object * Eigen::Vector3d(0, 0, landmark.shape.height / 2)).z();
  if (distance < kNear_m || distance > kFar_m) return std::nullopt;
  const auto shape = projectShape(landmark.shape, camera_from_object, camera);
  if (!shape || shape->visible.height() < kMinHeightShare * camera.height) return std::nullopt;
  if (shape->visible.area() < kMinShareInImage * shape->full.area()) return std::nullopt;
  const double margin = 0.3 + landmark.shape.horizontalExtent() / 2;
  if (hiddenShare(depth_at, shape->visible, distance, margin) >= kMaxHidden) return std::nullopt;
  return shape->visible;
}

bool shouldBeSeen(const Landmark& landmark, const Frame& frame, const Pose3& world_from_camera,
                  const std::vector<Detection>& detections) {
  if (!frame.hasDepth()) return false;
  const auto box = boxInGoodView(landmark, world_from_camera.inverse(), frame.camera,
                                 [&frame](double u, double v) { return frame.depthAt(u, v); });
  return box && std::none_of(detections.begin(), detections.end(),
                             [&box](const Detection& d) { return iou(d.box, *box) > kSamePlace; });
}

bool reaches(const Scan& scan, double range_m) { return !(scan.max_range_m > 0) || range_m <= scan.max_range_m; }

RayEvidence rayEvidence(const ObjectShape& shape, const Pose3& world_from_object, const Scan& scan,
                        const Pose3& world_from_robot, double solid_share) {
  RayEvidence out;
  const Pose3 object_from_lidar = world_from_object.inverse() * world_from_robot * scan.robot_from_lidar;
  const Eigen::Vector3d origin = object_from_lidar.translation();
  const double reach = std::hypot(shape.width, shape.depth) / 2, away = origin.head<2>().norm();
  if (origin.z() < 0 || origin.z() > shape.height || !reaches(scan, away) || away < reach) return out;
  const bool solid = origin.z() < solid_share * shape.height;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (!scan.valid[i]) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(i) * scan.angle_step_rad,
                 range = scan.ranges_m[i];
    const Eigen::Vector3d beam =
        object_from_lidar.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    const double nearest = -origin.head<2>().dot(beam.head<2>());  // of the beam to the object's middle
    if (nearest < 0 || range < away - reach) continue;
    const Eigen::Vector3d end = origin + range * beam;
    if (distanceOutside(shape, end)[0] <= 0) {
      ++out.inside;
    } else if (solid && range > away + reach) {
      const double beside = (origin + nearest * beam).head<2>().norm();
      out.through += beside < kMiddle * std::min(shape.width, shape.depth) / 2;
    }
  }
  return out;
}

}  // namespace roomgraph
