// SPDX-License-Identifier: BSD-3-Clause
// Synthetic room of chairs and sofas with detections, proposals and features per view.
#pragma once

#include <string>
#include <vector>

#include "random_poses.h"
#include "roomgraph/selection/proposal_selector.h"

namespace roomgraph::test {

/// An object of a made-up room.
struct RoomObject {
  std::string class_name;
  ObjectShape shape;
  Pose3 world_from_object = Pose3::Identity();
};

inline RoomObject chairAt(double x, double y) {
  return {"swivel_chair", {ShapeKind::kCylinder, 0.62, 0.62, 0.95}, poseFromYpr(x, y, 0, 0, 0, 0)};
}
inline RoomObject sofaAt(double x, double y, double yaw) {
  return {"sofa", {ShapeKind::kCuboid, 1.85, 0.88, 0.82}, poseFromYpr(x, y, 0, yaw, 0, 0)};
}

/// A level camera, 0.8 m above the ground, looking along `yaw`.
inline FrameContext viewFrom(double x, double y, double yaw) {
  FrameContext context;
  context.camera = {.width = 640, .height = 480, .fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
  context.world_from_camera = poseFromYpr(x, y, 0.8, yaw, 0, 0);
  context.world_from_camera.linear() *= bodyFromOptical();
  return context;
}

/// What is seen of `objects` (one detection each, where it is in the image, in order), each with `proposals`
/// hypotheses: the true one, then ones moved by up to `error_m`. `numbers` gets the object of each detection.
/// 12 points of every object's volume are added to the context's features; ids 100 * object + point.
inline FrameProposals seenFrom(FrameContext& context, const std::vector<RoomObject>& objects, int proposals,
                               double error_m, Random& random, std::vector<int>* numbers = nullptr) {
  FrameProposals out;
  const Pose3 camera_from_world = context.world_from_camera.inverse();
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const Pose3 camera_from_object = camera_from_world * objects[k].world_from_object;
    if (camera_from_object.translation().z() < 0.5) continue;
    const auto area = projectShape(objects[k].shape, camera_from_object, context.camera);
    if (!area) continue;
    if (numbers) numbers->push_back(static_cast<int>(k));
    const int j = static_cast<int>(out.detections.size());
    out.detections.push_back({area->visible, objects[k].class_name, objects[k].class_name, 0.9});
    for (int i = 0; i < proposals; ++i) {
      Proposal proposal{j, objects[k].class_name, objects[k].class_name, objects[k].shape,
                        camera_from_object};
      if (i > 0) proposal.camera_from_object.translation() += random.vector(error_m);
      const auto projected = projectShape(proposal.shape, proposal.camera_from_object, context.camera);
      if (!projected) continue;
      proposal.projected = *projected;
      proposal.box_iou = iou(projected->visible, area->visible);
      proposal.score = random.uniform(0.5, 1);
      out.proposals.push_back(proposal);
    }
    Random points(static_cast<unsigned>(k) + 1000);
    for (int p = 0; p < 12; ++p) {
      const double x = points.uniform(-.2, .2), y = points.uniform(-.2, .2), z = points.uniform(.1, .8);
      const Eigen::Vector3d seen = camera_from_object * Eigen::Vector3d(x, y, z);
      const Eigen::Vector2d pixel = context.camera.project(seen);
      if (seen.z() > 0.1 && context.camera.sees(pixel.x(), pixel.y()))
        context.features.push_back({pixel, 100 * static_cast<int>(k) + p, seen.z()});
    }
  }
  return out;
}

}  // namespace roomgraph::test
