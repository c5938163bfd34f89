// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// Estimate of a landmark in world.
struct LandmarkEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< bottom centre
  double yaw = 0;
};

/// What a solve did.
struct SolveReport {
  bool usable = false;  ///< the solution may be used (converged, or stopped early at a better point)
  double initial_cost = 0, final_cost = 0;  ///< half the sum of squared (robust) residuals
  int iterations = 0;
  std::string message;
};

/// Poses, landmarks and the factors between them; robust non-linear least squares (method.md Eq. 9).
/// Ids are the caller's; every id used in a factor must have been added before. Throws std::out_of_range
/// otherwise.
class FactorGraph {
 public:
  FactorGraph();
  ~FactorGraph();
  FactorGraph(FactorGraph&&) noexcept;
  FactorGraph& operator=(FactorGraph&&) noexcept;

  void addPose(NodeId id, const Pose3& world_from_robot, bool fixed = false);
  void addLandmark(LandmarkId id, const LandmarkEstimate& initial);
  void add(const BetweenFactor& factor);
  void add(const PlanarFactor& factor);
  void add(const GroundFactor& factor);
  void add(const LandmarkFactor& factor);
  void add(const LandmarkGroundFactor& factor);

  /// Minimises over everything that is not fixed. Deterministic, whatever the number of threads of the
  /// machine.
  SolveReport optimize(int max_iterations = 50);

  Pose3 pose(NodeId id) const;
  LandmarkEstimate landmark(LandmarkId id) const;
  bool hasLandmark(LandmarkId id) const;
  std::size_t poses() const;
  std::size_t landmarks() const;
  std::size_t factors() const;

  /// Marginal covariances (x, y, z, yaw) of landmarks at the current estimate; nothing when the problem is
  /// singular.
  std::optional<std::map<LandmarkId, Eigen::Matrix4d>> landmarkCovariances() const;

  /// g2o text: VERTEX_SE3:QUAT for poses and landmarks (landmark ids behind those of the poses),
  /// EDGE_SE3:QUAT between them. Throws RunError when the file cannot be written.
  void saveG2o(const std::filesystem::path& file) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
