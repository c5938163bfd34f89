// SPDX-License-Identifier: BSD-3-Clause
// ViewMemory: the images of a run by which its map can be re-localised.
#pragma once

#include <vector>

#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/repeated_views.h"
#include "roomgraph/tracking/key_views.h"

namespace roomgraph {

/// Keeps a view wherever the camera has moved on; where they are is told by the poses at the end.
class ViewMemory {
 public:
  explicit ViewMemory(const RelocalisationOptions& options) : options_(options) {}
  /// `people`: regions of the image that are left out, px.
  void add(const Frame& frame, const std::vector<Box2>& people, const Pose3& world_from_robot);
  /// Those that repeat others, when there are more than `kept`.
  void giveUpRepeated(std::size_t kept, const Trajectory& world_from_robot);
  /// Views of an earlier map, in whose frame world is, and those of this run with their poses of now, as many
  /// as a map keeps; of two of one place the run's.
  std::vector<KeyView> views(const KeyPoses& poses, const std::vector<KeyView>& earlier) const;

 private:
  RelocalisationOptions options_;
  std::vector<KeyView> views_;  ///< with robot_from_camera for world_from_camera
  GrowthWatch watch_;
  Pose3 last_from_ = Pose3::Identity();
};

}  // namespace roomgraph
