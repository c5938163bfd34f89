// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/visibility.h"

#include "roomgraph/geometry/projection.h"

namespace roomgraph {
namespace {

constexpr double kMinHeight_px = 50, kMinShareInImage = 0.7, kNear_m = 1.0, kFar_m = 4.0, kMaxHidden = 0.3;
constexpr double kSamePlace =
    0.3;  // IoU with a detection, of whatever label, that says that something is there

// Share of the depth pixels in the middle of the box that lie clearly in front of the object.
double hiddenShare(const Frame& frame, const Box2& box, double distance_m, double margin_m) {
  int seen = 0, hidden = 0;
  constexpr int kSteps = 12;
  for (int i = 1; i < kSteps; ++i) {
    for (int j = 1; j < kSteps; ++j) {
      const float z =
          frame.depthAt(box.u_min + box.width() * i / kSteps, box.v_min + box.height() * j / kSteps);
      if (z <= 0) continue;
      ++seen;
      hidden += z < distance_m - margin_m;
    }
  }
  return seen > 0 ? static_cast<double>(hidden) / seen : 1.0;
}

}  // namespace

bool shouldBeSeen(const Landmark& landmark, const Frame& frame, const Pose3& world_from_camera,
                  const std::vector<Detection>& detections) {
  const Pose3 camera_from_object = world_from_camera.inverse() * landmark.worldFromObject();
  const double distance = (camera_from_object * Eigen::Vector3d(0, 0, landmark.shape.height / 2)).z();
  if (distance < kNear_m || distance > kFar_m || !frame.hasDepth()) return false;
  const auto shape = projectShape(landmark.shape, camera_from_object, frame.camera);
  if (!shape || shape->visible.height() < kMinHeight_px) return false;
  if (shape->visible.area() < kMinShareInImage * shape->full.area()) return false;
  for (const auto& detection : detections)
    if (iou(detection.box, shape->visible) > kSamePlace) return false;
  const double margin = 0.3 + std::max(landmark.shape.width, landmark.shape.depth) / 2;
  return hiddenShare(frame, shape->visible, distance, margin) < kMaxHidden;
}

}  // namespace roomgraph
