// SPDX-License-Identifier: BSD-3-Clause
// Estimation of robot poses: key poses, sliding window, full optimisation, loop closures.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "roomgraph/estimation/graph_builder.h"
#include "roomgraph/geometry/ground.h"

namespace roomgraph {

/// A rigid move, in world, of everything that was first seen at that time or later.
struct PathShift {
  double since_t = 0;
  Pose3 new_from_old = Pose3::Identity();
};

/// Landmarks as an optimisation of the graph has them.
using LandmarkEstimates = std::map<LandmarkId, LandmarkEstimate>;

/// The robot's poses in world: key poses, what was measured between them, and the optimisations (method.md
/// sec. 4, M-step). Knows nothing of how objects are remembered: it is given what the graph is to hold of them and
/// returns where the optimisation puts them.
class PoseEstimator {
 public:
  /// Both outlive the estimator.
  PoseEstimator(const BackendOptions& options, const Motion& motion);

  const KeyPoses& poses() const { return poses_; }
  /// The graph as it was last optimised as a whole.
  const FactorGraph& graph() const { return graph_; }
  /// Whether the robot drives on the floor; else the camera is handheld.
  bool planar() const { return measurements_.planar; }
  /// Whether the floor has been seen by a handheld camera, so that z is up in world.
  bool levelled() const { return levelled_; }
  int closureCount() const { return static_cast<int>(measurements_.closures.size()); }

  void setPlanar() { measurements_.planar = true; }
  /// Adds a key pose when the robot moved far enough since the last one; returns whether it did.
  bool advance(double t);
  /// A closure over a gap that no source of motion saw across also lays the poses after the gap where it says;
  /// what was first seen there is to be moved likewise.
  std::vector<PathShift> addClosures(const std::vector<RelativePose>& closures);
  /// The floor as a handheld camera saw it in depth at time t (a plane in the camera's frame). The first one levels
  /// the world; later ones, seen from a key pose, become factors. Nothing for a robot on the floor.
  void addFloor(double t, const Plane& in_camera, const Pose3& robot_from_camera);

  /// Whether it is time to optimise everything, not just the latest key poses.
  bool due() const;
  /// Optimises the latest key poses.
  void optimizeWindow();
  /// Optimises everything, within the time that a run can spare; nothing when the solver found no usable solution.
  std::optional<LandmarkEstimates> optimizeLive(const ObjectsInGraph& objects);
  /// Optimises everything to the end; nothing when the solver found no usable solution.
  std::optional<LandmarkEstimates> optimizeAll(const ObjectsInGraph& objects);
  /// Moves the world frame rigidly.
  void transform(const Pose3& new_from_old);

 private:
  std::optional<LandmarkEstimates> optimize(const ObjectsInGraph& objects, const SolveOptions& until);
  void slideWindow();
  void restartWindow();
  bool surprising(const RelativePose& closure) const;
  std::optional<PathShift> reconnect(const RelativePose& closure);

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
  bool levelled_ = false;
};

}  // namespace roomgraph
