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

/// Where a landmark was seen, for finding out that it is two.
struct PlaceSketch {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double sigma_m = 0;  ///< larger standard deviation on the ground
  double weight = 1;
};

/// Evidence for or against a landmark's existence other than a sighting: a miss, or rays.
struct Doubt {
  FrameId after;  ///< the last frame with measurements before it
  double log_ratio = 0;
};

/// What is remembered about a landmark beside its estimate.
struct LandmarkRecord {
  double evidence = 0;                   ///< sum of the sightings' scores
  double ray_support = 0;                ///< log odds of existence that rays gave in favour
  std::vector<Doubt> doubts;             ///< in order of time
  std::map<std::string, double> labels;  ///< class -> sum of the detector's scores
  double front = 0, back = 0;            ///< votes for the landmark's yaw and for the opposite one
  double size_weight = 0;                ///< of the sightings in its size
  std::deque<PlaceSketch> recent;
};

/// Whether a sighting lies so far off the landmark that it was given to it for other reasons than its place.
bool isElsewhere(const Landmark& landmark, const WorldMeasurement& seen);
/// Kalman update of (x, y, z, yaw) with a direct measurement; one of little weight counts as a less certain
/// one.
void fusePlace(Landmark& landmark, const WorldMeasurement& seen);
/// Front against back: the yaw turns round when more weight has seen it the other way.
void voteYaw(Landmark& landmark, LandmarkRecord& record, const WorldMeasurement& seen);
/// Mean size, by weight and by how much of the object the image shows.
void fuseSize(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen);
/// Counts a label and keeps the class posterior: the votes with a small even prior (Dirichlet) over the
/// classes met.
void voteLabel(Landmark& landmark, LandmarkRecord& record, const ObjectMeasurement& seen);
void remember(LandmarkRecord& record, const WorldMeasurement& seen);
/// Adds what is known about `other`, whose yaw may point the other way.
void joinRecords(LandmarkRecord& record, const LandmarkRecord& other, bool turned);

/// Two groups of sightings that one object cannot explain.
struct Split {
  Eigen::Vector2d first, second;  ///< means
  std::vector<char> is_second;    ///< per sighting
  double second_share = 0;        ///< of the weight, at most one half
};

/// Looks for two modes at least `least_distance_m` apart, each with a quarter of the weight and three
/// sightings, each narrow against their distance; sightings too vague to tell are left out.
std::optional<Split> findSplit(const std::vector<PlaceSketch>& sightings, double least_distance_m);

}  // namespace roomgraph
