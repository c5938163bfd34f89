// SPDX-License-Identifier: BSD-3-Clause
// Maker of scenes: a made-up room seen frame by frame, with right and rival proposals.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "roomgraph/geometry/box_sides.h"
#include "selection_scenes.h"

namespace roomgraph::test {

/// Builds a scene frame by frame: true boxes with noise, proposals with the noise of a measured range,
/// features whose tracks break. Draws from `random` in the order of the calls.
class SceneMaker {
 public:
  SceneMaker(unsigned seed, const std::vector<RoomObject>& objects)
      : random(seed), objects_(objects), generation_(objects.size() + 1, std::vector<int>(24, 0)) {}

  /// A new frame. `yaw_error`: of the estimate, against which all is drawn.
  void look(double x, double y, double yaw, double yaw_error = 0) {
    SceneFrame frame;
    frame.context = viewFrom(x, y, yaw);
    true_view_ = frame.context;
    frame.context = viewFrom(x + random.uniform(-.003, .003), y + random.uniform(-.003, .003),
                             yaw + random.uniform(-.001, .001) + yaw_error);
    frame.proposals.frame = FrameId{static_cast<std::int64_t>(scene.size())};
    scene.push_back(std::move(frame));
  }

  Pose3 inCamera(int object) const {
    return true_view_.world_from_camera.inverse() * at(object).world_from_object;
  }
  Box2 areaOf(const ObjectShape& shape, const Pose3& camera_from_object) const {
    const auto area = projectShape(shape, camera_from_object, true_view_.camera);
    return area ? area->visible : Box2{};
  }
  Box2 boxOf(int object) const { return areaOf(at(object).shape, inCamera(object)); }

  void move(int object, const Eigen::Vector3d& by) {
    objects_[static_cast<std::size_t>(object)].world_from_object.translation() += by;
  }

  /// A detection of an object (-1: false alarm of a chair) in a box, with noise.
  void detect(int object, Box2 box, double alpha) {
    for (double* side : {&box.u_min, &box.v_min, &box.u_max, &box.v_max})
      *side += random.uniform(-kBoxNoise_px, kBoxNoise_px);
    const std::string name = object < 0 ? "swivel_chair" : at(object).class_name;
    scene.back().proposals.detections.push_back({clipped(box, 640, 480), name, name, alpha});
    scene.back().objects.push_back(object);
  }

  /// A proposal for the last detection, with the noise of a measured range.
  void propose(bool right, const ObjectShape& shape, Pose3 camera_from_object, double score,
               const BoxSides& hidden = {}) {
    auto& frame = scene.back().proposals;
    camera_from_object.translation() *= 1 + random.uniform(-kRangeNoise, kRangeNoise);
    camera_from_object.translation().x() += random.uniform(-kPlaceNoise_m, kPlaceNoise_m);
    const auto projected = projectShape(shape, camera_from_object, true_view_.camera);
    if (!projected) return;
    const Detection& detection = frame.detections.back();
    Proposal proposal{static_cast<int>(frame.detections.size()) - 1, detection.class_name,
                      detection.class_name, shape, camera_from_object};
    proposal.projected = *projected;
    Box2& visible = proposal.projected.visible;
    if (hidden.left) visible.u_min = detection.box.u_min;  // counts as met
    if (hidden.right) visible.u_max = detection.box.u_max;
    if (hidden.bottom) visible.v_max = detection.box.v_max;
    proposal.box_iou = iou(visible, detection.box);
    proposal.score = std::clamp(score, 0.0, 1.0);
    proposal.source = right ? "right" : "rival";
    frame.proposals.push_back(std::move(proposal));
  }

  /// An object's true pose, and the same moved along the floor to `scale` times the distance.
  void proposeTrue(int object, double score, const BoxSides& hidden = {}) {
    propose(true, at(object).shape, inCamera(object), score, hidden);
  }
  void proposeAtDepth(int object, double scale, double score, const BoxSides& hidden) {
    Pose3 pose = inCamera(object);
    pose.translation().x() *= scale;  // the camera is level: y is the height
    pose.translation().z() *= scale;
    // The fit makes the shape as much smaller or larger as the class's sizes leave room for: 15 %.
    ObjectShape shape = at(object).shape;
    const double fitted = std::clamp(scale, 0.85, 1.15);
    shape.width *= fitted;
    shape.depth *= fitted;
    propose(false, shape, pose, score, hidden);
  }

  /// Points on every object that no occluder's box hides, followed by the tracker; the occluder's own, too.
  void track(const std::vector<Box2>& occluders = {}, const std::vector<int>& before = {}) {
    for (int k = 0; k < static_cast<int>(objects_.size()); ++k) {
      Random points(static_cast<unsigned>(k) + 1000);
      for (int p = 0; p < 24; ++p) {
        const Eigen::Vector3d on_object{points.uniform(-.2, .2), points.uniform(-.2, .2),
                                        points.uniform(.1, .8)};
        const Eigen::Vector3d seen = inCamera(k) * on_object;
        const Eigen::Vector2d pixel = true_view_.camera.project(seen);
        if (seen.z() < 0.1 || !true_view_.camera.sees(pixel.x(), pixel.y())) continue;
        bool hidden = false;
        for (std::size_t o = 0; o < occluders.size(); ++o)
          hidden =
              hidden || (occluders[o].contains(pixel.x(), pixel.y()) && (before.empty() || before[o] != k));
        int& generation = generation_[static_cast<std::size_t>(k)][static_cast<std::size_t>(p)];
        if (hidden || random.uniform(0, 1) < kFeatureLost) ++generation;  // a new track when it is seen again
        if (!hidden) add(pixel, 10000 * k + 100 * p + generation % 100, seen.z());
      }
    }
    for (std::size_t o = 0; o < occluders.size(); ++o)
      for (int p = 0; before.empty() && p < 20; ++p)  // moves by itself: never the same point
        add({random.uniform(occluders[o].u_min, occluders[o].u_max),
             random.uniform(occluders[o].v_min, occluders[o].v_max)},
            next_loose_++, 1);
  }

  const RoomObject& at(int object) const { return objects_[static_cast<std::size_t>(object)]; }

  Random random;
  Scene scene;

 private:
  static constexpr double kFeatureLost = 0.1;  ///< share of the features that are lost from frame to frame
  static constexpr double kBoxNoise_px = 3, kPlaceNoise_m = 0.03, kRangeNoise = 0.02;

  void add(const Eigen::Vector2d& pixel, std::int64_t point, double depth_m) {
    scene.back().context.features.push_back({pixel, point, depth_m});
  }

  std::vector<RoomObject> objects_;
  std::vector<std::vector<int>> generation_;  // [object][point]: how often its track broke
  FrameContext true_view_;
  std::int64_t next_loose_ = 1000000;
};

}  // namespace roomgraph::test
