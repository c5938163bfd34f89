// SPDX-License-Identifier: BSD-3-Clause
// Recursive update rules of a landmark: Kalman position, yaw and label votes, mean size, bimodality test.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/association/world_measurement.h"

namespace roomgraph {

constexpr double kMaxRaySupport = 1;  ///< log odds of existence that rays may give
constexpr double kClearMajority = 3;  ///< ratio of label votes that changes the class: detectors often confuse classes

/// Position of one sighting, for the test whether a landmark is two objects.
struct PlaceSketch {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double sigma_m = 0;  ///< larger standard deviation on the ground
  double weight = 1;
};

/// Change of a landmark's existence by something other than a sighting: a miss, or rays.
struct ExistenceUpdate {
  FrameId after;         ///< the last frame with measurements before it
  double log_ratio = 0;  ///< added to the log odds of existence
  FrameId missed_in;     ///< of a miss: the frame that should have shown it
};

/// Record of a landmark beside its estimate.
struct LandmarkRecord {
  double evidence = 0;                             ///< sum of the sightings' weights
  double ray_support = 0;                          ///< log odds of existence gained from rays
  std::vector<ExistenceUpdate> existence_updates;  ///< in order of time
  std::map<std::string, double> labels;            ///< class -> sum of the sightings' weights
  double front = 0, back = 0;                      ///< votes for the landmark's yaw and for the opposite one
  double size_weight = 0;                          ///< of the sightings in its size
  std::deque<PlaceSketch> recent;
};

/// Whether the sighting's position is an outlier with respect to the landmark (it was assigned by track or features).
bool isElsewhere(const Landmark& landmark, const WorldMeasurement& seen);
/// Kalman update of (x, y, z, yaw); the covariance of carried boxes and of outliers is inflated.
void fusePlace(Landmark& landmark, const WorldMeasurement& seen);
/// Votes for the front: the yaw is reversed when sightings with the opposite yaw have more weight.
void voteYaw(Landmark& landmark, LandmarkRecord& record, const WorldMeasurement& seen);
/// Mean size, weighted by the sighting's weight and its visible fraction.
void fuseSize(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen);
/// Adds a vote for the label and updates the class posterior: votes with an even Dirichlet prior over the
/// classes seen.
void voteLabel(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen);
void remember(LandmarkRecord& record, const WorldMeasurement& seen);
/// Adds the record of a merged landmark; `turned`: its yaw is the opposite one. What rays said of both between the same frames counts
/// once, and all that speaks for it up to kMaxRaySupport.
void joinRecords(LandmarkRecord& record, const LandmarkRecord& other, bool turned);

/// Two groups of sightings too far apart for one object.
struct Split {
  Eigen::Vector2d first, second;  ///< means
  std::vector<char> is_second;    ///< per sighting
  double second_share = 0;        ///< of the weight, at most one half
};

/// Looks for two modes at least `least_distance_m` apart, each with a quarter of the weight and three
/// sightings, each narrow against their distance; sightings with a large standard deviation are left out.
std::optional<Split> findSplit(const std::vector<PlaceSketch>& sightings, double least_distance_m);

}  // namespace roomgraph
