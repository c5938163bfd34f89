// SPDX-License-Identifier: BSD-3-Clause
// Conversion of poses, and lookup of landmarks and of parts of the path.
#include "roomgraph/viewer/view_state.h"

namespace roomgraph {

ShownPose toShown(const StampedPose& stamped) {
  const Eigen::Vector3f at = stamped.pose.translation().cast<float>();
  return {stamped.t, at.x(), at.y(), at.z(), static_cast<float>(planarPart(stamped.pose).yaw)};
}

const ShownLandmark* findLandmark(const ViewState& state, LandmarkId id) {
  if (!state.landmarks) return nullptr;
  for (const auto& shown : *state.landmarks)
    if (shown->landmark.id == id) return shown.get();
  return nullptr;
}

std::vector<StampedPose> pathUntil(const ShownPath& path, double t) {
  std::vector<StampedPose> out;
  for (const auto& [at, x, y, z, yaw] : path) {
    if (at > t) break;
    out.push_back({at, poseFromYpr(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z),
                                   static_cast<double>(yaw), 0, 0)});
  }
  return out;
}

}  // namespace roomgraph
