// SPDX-License-Identifier: BSD-3-Clause
// Choice of the frames that become views, and their poses at the end.
#include "roomgraph/estimation/view_memory.h"

namespace roomgraph {
namespace {

constexpr double kShare = 0.4;  // of the distance between views: those of a map are chosen among these
constexpr std::size_t kLeastCorners = 30;

}  // namespace

void ViewMemory::add(const Frame& frame, const std::vector<Box2>& people, const Pose3& world_from_robot) {
  if (options_.views == 0) return;
  const Pose3 world_from_camera = world_from_robot * frame.robot_from_camera;
  if (!views_.empty()) {
    const Pose3 moved = last_from_.inverse() * world_from_camera;
    if (moved.translation().norm() / options_.view_distance_m +
            rotationAngle(moved) / options_.view_angle_rad <
        kShare)
      return;
  }
  KeyView view = makeKeyView(frame, people, options_.view_corners);
  if (view.corners.size() < kLeastCorners) return;
  last_from_ = world_from_camera;
  view.world_from_camera = frame.robot_from_camera;
  views_.push_back(std::move(view));
}

void ViewMemory::giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot) {
  constexpr ViewLimits kViews{.of_a_view = 3};  // a map keeps one of a place
  roomgraph::giveUpRepeated(views_, watch_, kept, world_from_robot, [](const KeyView& view) { return view.t; }, kViews);
}

std::vector<KeyView> ViewMemory::views(const KeyPoses& poses, const std::vector<KeyView>& earlier) const {
  std::vector<KeyView> all = earlier;
  for (const KeyView& view : views_) {
    all.push_back(view);
    all.back().world_from_camera = poses.at(view.t) * view.world_from_camera;
  }
  return thinnedViews(std::move(all), static_cast<std::size_t>(options_.views), options_.view_distance_m,
                      options_.view_angle_rad);
}

}  // namespace roomgraph
