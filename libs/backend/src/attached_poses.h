// SPDX-License-Identifier: BSD-3-Clause
// Factors of poses that move rigidly with another one, told of that one.
#pragma once

#include <map>
#include <optional>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// A pose without variables of its own.
struct AttachedPose {
  NodeId to;
  Pose3 to_from_pose = Pose3::Identity();
};
using AttachedPoses = std::map<NodeId, AttachedPose>;

/// The factor as the poses see it to which its own are attached; nothing when it ties such a pose to itself. It costs the
/// same, a movement to the first order in its residual. Throws std::invalid_argument for a MarginalPrior of such a pose.
std::optional<Factor> toldOfBodies(const Factor& factor, const AttachedPoses& attached);

}  // namespace roomgraph
