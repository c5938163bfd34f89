// SPDX-License-Identifier: BSD-3-Clause
// LandmarkMap: recursive estimate of all landmarks with existence, birth, merging and splitting.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "roomgraph/association/associator.h"
#include "roomgraph/association/former_sighting.h"
#include "roomgraph/association/landmark_fusion.h"
#include "roomgraph/association/landmark_identity.h"
#include "roomgraph/association/landmark_options.h"
#include "roomgraph/association/reassociation.h"

namespace roomgraph {

/// Recursive estimate of the landmarks between two optimisations of the graph: Kalman update of place,
/// weighted mean of the size, votes for class and front, Bernoulli filter for existence, merging and
/// splitting. The only owner of landmarks and of their ids during a run.
class LandmarkMap {
 public:
  explicit LandmarkMap(const LandmarkOptions& options = {}) : options_(options) {}

  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  const Landmark* find(LandmarkId id) const;
  const LandmarkIdentity& identity() const { return identity_; }
  const LandmarkRules& rules() const { return options_.rules; }

  /// Fuses a measurement into its landmark, or makes a new one; returns the landmark's id. A measurement of
  /// another class than its landmark's only votes for its label; when that label has far more votes, the
  /// landmark takes class, shape and place of the measurement.
  LandmarkId update(const WorldMeasurement& measurement, const Association& association);

  /// Lowers the existence of a landmark that should have been detected and was not.
  void miss(LandmarkId id, FrameId frame = {});

  /// Number of rays of one scan that passed through the landmark's volume (evidence against it), or ended
  /// inside its footprint (evidence for it). Rays of a scan are not independent: their number is limited.
  void seenThrough(LandmarkId id, int rays);
  void supported(LandmarkId id, int rays);

  /// What a sighting says about the landmark's existence, added to its log odds; 0 for an unknown landmark.
  double existenceLogRatio(LandmarkId id, const WorldMeasurement& sighting) const;

  /// Sets place (m, world), yaw (rad) and covariance of (x, y, z, yaw) after an optimisation of the graph.
  void correct(LandmarkId id, const Eigen::Vector3d& position, double yaw, const ObjectShape& shape,
               const Eigen::Matrix4d& covariance);

  /// Transforms a landmark, with the positions in its record, into another frame.
  void move(LandmarkId id, const Pose3& new_from_old);

  /// It was moved to this place (ground, world, m): what rays and misses said of it is forgotten. `same`: a landmark that becomes
  /// part of it.
  void setMoved(LandmarkId id, std::optional<LandmarkId> same, const Eigen::Vector2d& place);

  /// Merges landmarks of one class that are one object; returns (removed, kept) pairs.
  std::vector<std::pair<LandmarkId, LandmarkId>> mergeDuplicates();

  /// Splits landmarks whose recent sightings form two groups farther apart than one object allows; returns
  /// (split, created) pairs.
  std::vector<std::pair<LandmarkId, LandmarkId>> splitMixed();

  /// Replaces the landmarks by those of a re-association of all measurements. Existence is computed anew from
  /// the sightings assigned to each landmark and, in the order of time, its recorded misses and rays, and `former` sightings
  /// (with the ids of `result`), which are not in `by_frame`.
  void adopt(const std::vector<std::vector<WorldMeasurement>>& by_frame, const Reassociation& result,
             const std::vector<FormerSighting>& former = {});

  /// Ids up to this one belong to the landmarks of an earlier map: new ones come after it.
  void reserveIds(LandmarkId last) { identity_.reserve(last); }
  /// Gives a landmark the id that an earlier map has for it; no landmark has had it in this run.
  void rename(LandmarkId own, LandmarkId earlier);
  /// Sum of the weights of its sightings; 0 for an unknown one.
  double weightOf(LandmarkId id) const;

  /// Landmarks for the map: confirmed ones, as far as they are exclusive().
  std::vector<Landmark> confirmed() const;
  /// Whether existence and number of observations reach the configured limits.
  bool isConfirmed(const Landmark& landmark) const;
  /// Without those that another one with more evidence overlaps; by id.
  std::vector<Landmark> exclusive(std::vector<Landmark> landmarks) const;

 private:
  Landmark* get(LandmarkId id);
  /// As update(); `class_is_known`: no label changes it.
  LandmarkId fuse(const WorldMeasurement& seen, const Association& association, bool class_is_known);
  /// Where other labels have far more votes, the landmark is of that class, and begins with its first sighting.
  void classify(const std::vector<std::vector<WorldMeasurement>>& by_frame, const Reassociation& result,
                const std::vector<FormerSighting>& former);
  void weigh(Landmark& landmark, double ratio) const;
  void updateExistence(LandmarkId id, double log_ratio, FrameId missed_in = {});
  double likelihoodRatio(const Landmark& landmark, const WorldMeasurement& seen) const;
  void countFormerUntil(FrameId frame, std::vector<FormerSighting>::const_iterator& next,
                        const std::vector<FormerSighting>& former);
  void countTogether(FrameId frame, LandmarkId id);
  void merge(std::size_t kept, std::size_t removed);
  void join(Landmark& kept, const Landmark& removed);
  int together(LandmarkId a, LandmarkId b) const;

  LandmarkOptions options_;
  std::vector<Landmark> landmarks_;
  std::map<LandmarkId, LandmarkRecord> records_;
  SeenTogether together_;
  FrameId frame_;
  std::vector<LandmarkId> in_frame_;
  LandmarkIdentity identity_;
};

}  // namespace roomgraph
