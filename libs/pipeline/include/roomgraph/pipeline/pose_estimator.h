// SPDX-License-Identifier: BSD-3-Clause
// Estimation of robot poses: key poses, sliding window, full optimisation, loop closures.
#pragma once

#include <vector>

#include "roomgraph/pipeline/graph_builder.h"
#include "roomgraph/pipeline/object_mapper.h"

namespace roomgraph {

/// The robot's poses in world, and with them the landmarks: key poses, what was measured between them, and
/// the optimisations of both (method.md sec. 4, M-step).
class PoseEstimator {
 public:
  PoseEstimator(const BackendOptions& options, const Motion& motion);

  const KeyPoses& poses() const { return poses_; }
  Measurements& measurements() { return measurements_; }
  const Measurements& measurements() const { return measurements_; }
  /// The graph as it was last optimised as a whole.
  const FactorGraph& graph() const { return graph_; }

  /// Adds a key pose when the robot moved far enough since the last one; returns whether it did.
  bool advance(double t);
  /// A closure over a gap that no source of motion saw across also lays the poses after the gap, and the
  /// landmarks first seen there, where it says.
  void addClosures(const std::vector<RelativePose>& closures, ObjectMapper& objects);
  /// Whether the next update is to optimise everything.
  bool due() const;
  /// Optimises the latest key poses, or everything when that is due.
  void update(ObjectMapper& objects);
  /// Optimises everything to the end; false when the solver found nothing usable.
  bool optimizeAll(ObjectMapper& objects);
  /// Moves the world frame rigidly.
  void transform(const Pose3& new_from_old);

 private:
  bool optimizeAll(ObjectMapper& objects, const SolveOptions& until);
  void optimizeWindow();
  void slideWindow();
  void restartWindow();
  bool surprising(const RelativePose& closure) const;
  void reconnect(const RelativePose& closure, ObjectMapper& objects);

  const BackendOptions& options_;
  const Motion& motion_;
  KeyPoses poses_;
  Measurements measurements_;
  FactorGraph graph_;
  Window window_;                       ///< of the latest key poses
  std::size_t first_ = 0;               ///< oldest key pose in it
  std::optional<MarginalPrior> prior_;  ///< what was measured before says of them, since all was optimised
  int nodes_since_optimization_ = 0;
  bool surprised_ = false;  ///< a closure disagrees with the estimate: do not wait long
};

}  // namespace roomgraph
