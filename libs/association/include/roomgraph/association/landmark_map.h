// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/geometry/camera.h"

namespace roomgraph {

/// Recursive estimate of the landmarks between two optimisations of the graph: Kalman update of place and
/// size, Bernoulli filter for existence, merging of duplicates. The one owner of landmarks while a run goes
/// on.
class LandmarkMap : public Configurable {
 public:
  void declareParameters(ParameterVisitor& visitor) override;

  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  const Landmark* find(LandmarkId id) const;

  /// Fuses a measurement into its landmark, or makes a new one; returns the landmark's id.
  LandmarkId update(const WorldMeasurement& measurement, const Association& association);

  /// Lowers the existence of a landmark that should have been detected and was not.
  void miss(LandmarkId id);

  /// Sets place, yaw and covariance after an optimisation of the graph.
  void correct(LandmarkId id, const Eigen::Vector3d& position, double yaw, const Eigen::Matrix4d& covariance);

  /// Joins landmarks of one class that overlap; returns (removed, kept) pairs.
  std::vector<std::pair<LandmarkId, LandmarkId>> mergeDuplicates();

  /// Landmarks sure enough to be shown: existence and number of observations reach the configured limits.
  std::vector<Landmark> confirmed() const;

 private:
  Landmark* get(LandmarkId id);
  void weigh(Landmark& landmark, double ratio) const;

  std::vector<Landmark> landmarks_;
  std::map<LandmarkId, double> evidence_;  ///< sum of the sightings' scores
  std::int64_t next_id_ = 0;
  double birth_existence_ = 0.3, detection_probability_ = 0.6, false_alarm_probability_ = 0.15;
  double score_gain_ = 5, neutral_score_ = 0.3;
  double confirm_existence_ = 0.9, merge_overlap_ = 0.2, exclusive_overlap_ = 0.3;
  int confirm_observations_ = 6;
};

}  // namespace roomgraph
