// SPDX-License-Identifier: BSD-3-Clause
// Objects that somebody moved by less than two of a kind can stand apart: where they stand now, and since when. Or that are gone.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_frames.h"
#include "roomgraph/observations/landmark.h"
#include "space_memory.h"

namespace roomgraph {

/// Where a sighting places an object on the ground, m, world.
struct PlaceInTime {
  double t = 0;  ///< s
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

/// Where it stood from `since_t` until `last_t` (s), and from `first_t` on: its sightings.
struct ChangeOfPlace {
  double since_t = 0, last_t = 0, first_t = 0;
  Eigen::Vector2d before = Eigen::Vector2d::Zero(), after = Eigen::Vector2d::Zero();
};

/// The pause between two visits that divides the sightings (in order of time) best: the sum of distances from the median places
/// before and after it is least. Of the latest twenty. Nothing when these are nearer to each other than .25 m or than twice what a quarter of
/// the sightings is off, or are of fewer than three sightings
/// or less than a second.
std::optional<ChangeOfPlace> changeOfPlace(const std::vector<PlaceInTime>& seen);

/// A landmark, with another one of its class that stands where it cannot stand beside it and is the same object.
struct MovedLandmark {
  LandmarkId landmark;
  std::optional<LandmarkId> same;
  ChangeOfPlace change;
};

/// Those whose sightings say so, of the landmarks that were sighted at `since_t` (s) or later; first those that do alone, so that
/// one may come again. Doors, and all that is planar, stay where they are.
std::vector<MovedLandmark> movedLandmarks(const std::vector<Landmark>& landmarks, const ObjectFrames& frames, const KeyPoses& poses,
                                          double since_t);

/// Whether depth images say so as well: most of what they saw filled where only the one place is was free at the time of the other.
bool raysAgree(const Landmark& landmark, const ChangeOfPlace& change, const PosedViews& views);

/// Of the points in its volume that depth images saw filled until it was sighted last (s), the share that is free half a minute
/// later and after: from 0 (.4 of them, or fewer than eight of them are known) to 1.
double emptiedSince(double last_sighting_t, const Landmark& landmark, const PosedViews& views);

}  // namespace roomgraph
