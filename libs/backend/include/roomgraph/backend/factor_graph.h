// SPDX-License-Identifier: BSD-3-Clause
// FactorGraph: poses, landmarks and points with their factors, solved by robust non-linear least squares.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/backend/factors.h"

namespace roomgraph {

/// When to stop iterating.
struct SolveOptions {
  int max_iterations = 50;
  double function_tolerance = 1e-8;  ///< relative change of the cost below which it stops
  /// Called after every iteration. May be empty.
  std::function<void(int iteration, double cost)> progress = {};
  /// Powell's dogleg in place of Levenberg's and Marquardt's damping: a step that fails is shortened without the
  /// equations being solved again. For graphs whose robust losses make many steps fail.
  bool dogleg = false;
};

/// Outcome of an optimisation.
struct SolveReport {
  bool usable = false;  ///< the solution may be used (converged, or stopped early at a better point)
  double initial_cost = 0, final_cost = 0;  ///< half the sum of squared (robust) residuals
  int iterations = 0;
  std::string message;
};

struct PlanarGraph;
using NodeTimes = std::map<NodeId, double>;  ///< s

/// Poses, landmarks, points and the factors between them; robust non-linear least squares (method.md Eq. 9).
/// Ids are the caller's; every id used in a factor must have been added before. Throws std::out_of_range
/// otherwise. Results do not depend on the number of threads: the same input gives the same bits.
class FactorGraph {
 public:
  FactorGraph();
  ~FactorGraph();
  FactorGraph(FactorGraph&&) noexcept;
  FactorGraph& operator=(FactorGraph&&) noexcept;

  void addPose(NodeId id, const Pose3& world_from_robot, bool fixed = false);
  /// A pose that moves rigidly with `to`, which is in the graph and not attached itself: it has no variables, and factors
  /// that are added of it are told of `to`. Those between poses of one such body are left out; a MarginalPrior of one is
  /// refused with std::invalid_argument. Files of the graph do not hold such poses.
  void attach(NodeId id, NodeId to, const Pose3& world_from_robot);
  /// The pose with which this one moves: that to which it is attached, or itself, also when it is not in the graph.
  NodeId bodyOf(NodeId id) const;
  void addLandmark(LandmarkId id, const LandmarkEstimate& initial);
  void addPoint(PointId id, const Eigen::Vector3d& in_world);
  /// Throws std::invalid_argument when the landmark of a LandmarkBoxFactor or PointLandmarkFactor has no
  /// size.
  void add(const Factor& factor);
  /// A movement between poses of two bodies, each of several poses: it counts once addSums() has put one factor in place of all
  /// between the same two. That costs what they cost to the second order, with the weights that robust losses give them at the
  /// estimate as it is now. Any other movement is added at once. Poses are attached before.
  void addToSum(const BetweenFactor& factor);
  void addSums();

  /// Minimises over everything that is not fixed. The yaw of a landmark is variable only if a factor measures it, its
  /// size only with a LandmarkSizeFactor.
  SolveReport optimize(int max_iterations = 50);
  SolveReport optimize(const SolveOptions& options);
  /// Every number that optimize() may change, in an order that depends only on what the graph holds.
  std::vector<double> values() const;
  /// Takes over what values() gave of the same graph. Throws std::invalid_argument when the graph holds more
  /// or less.
  void setValues(const std::vector<double>& values);
  /// Takes over what `former` found for these variables, where both graphs hold them.
  void startFrom(const FactorGraph& former, const Variables& variables);
  /// Initialises the poses from the movements alone by chordal relaxation, which needs no good initial estimate; kept
  /// when they lower the cost. Only for graphs of poses and movements. Returns whether anything changed.
  bool initializePoses();
  /// Sum of squared residuals, whitened and weighted, with robust losses applied: twice the cost.
  /// NaN when it cannot be evaluated (a residual is not finite or too large).
  double chiSquared() const;

  Pose3 pose(NodeId id) const;
  LandmarkEstimate landmark(LandmarkId id) const;
  Eigen::Vector3d point(PointId id) const;
  bool hasLandmark(LandmarkId id) const;
  std::size_t poses() const;
  std::size_t landmarks() const;
  std::size_t factors() const;

  /// Marginal covariances (x, y, z, yaw) of landmarks at the current estimate; nothing when the problem is
  /// singular or cannot be evaluated. A yaw that nothing measures is uniform over the circle.
  std::optional<std::map<LandmarkId, Eigen::Matrix4d>> landmarkCovariances() const;
  /// Of these landmarks only, each once; those that the graph does not hold are left out.
  std::optional<std::map<LandmarkId, Eigen::Matrix4d>> landmarkCovariances(const std::vector<LandmarkId>& of) const;

  /// Marginalises everything but `keep` (Schur complement at the current estimate). The prior contains every factor on
  /// a removed variable, and every MarginalPrior; the caller adds it, and the factors among kept variables, to a graph
  /// of the kept variables. Nothing when the removed part has no factor on a kept variable, or cannot be evaluated.
  std::optional<MarginalPrior> marginalize(const Variables& keep) const;

  /// g2o text: VERTEX_SE3:QUAT for poses and landmarks (landmark ids behind those of the poses),
  /// EDGE_SE3:QUAT between them, in g2o's own error convention (docs/formats.md). The format has
  /// no priors, points and robust losses. `times` of poses are written as comments. Throws RunError when the file
  /// cannot be written.
  void saveG2o(const std::filesystem::path& file, const NodeTimes& times = {}) const;
  /// The graph projected onto the floor: the same vertices (landmarks too) and edges, without height, roll and pitch.
  PlanarGraph planar() const;

  struct Impl;  ///< private

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace roomgraph
