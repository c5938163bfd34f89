// SPDX-License-Identifier: BSD-3-Clause
// Landmarks of an earlier map continued by those of a run in its frame.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/landmark_rules.h"
#include "roomgraph/observations/landmark.h"

namespace roomgraph {

/// What a run saw of the place where an earlier map has a landmark.
struct PlaceLook {
  int missed = 0;          ///< images with the place in good view in which the detector found nothing there
  double known = 0;        ///< share of the landmark's volume that depth rays crossed or ended in
  double filled = 0;       ///< of that, the share where they ended
  double beams_known = 0;  ///< the same of its footprint, by lidar beams; of solid classes only
  double beams_filled = 0;
};

/// Change of the log odds that the landmark is where it was (method.md sec. 4.10): misses count against it;
/// rays through its place against it, rays that end there for it, by how much of it they saw.
double logRatioOf(const PlaceLook& look);

/// Own landmarks that are one of the earlier map (own id -> earlier id), one to one, the nearest first: of
/// one class by the rule for duplicates, of two classes when they cover each other. `own` with an id of the
/// earlier map are left out: they are matched already.
std::map<LandmarkId, LandmarkId> sameLandmarks(const std::vector<Landmark>& own,
                                               const std::vector<Landmark>& earlier,
                                               const DuplicateRule& rule);

/// One landmark and the weight of its sightings.
struct WeighedLandmark {
  Landmark landmark;
  double weight = 0;
};

/// Landmarks of both, by id, as far as they exist, and how many are what.
struct ContinuedLandmarks {
  std::vector<WeighedLandmark> landmarks;
  int seen_again = 0, appeared = 0, vanished = 0, unseen = 0;
};

/// What the continuation goes by.
struct ContinuationRule {
  double least_existence = 0.5;
  double exclusive_overlap = 0.15;  ///< of footprints: two objects cannot stand in one place
};

/// `earlier` with what the run says about each: an own landmark of its id, in the map or not (`candidates`),
/// is fused with it; besides, `looks` (one for each) raise or lower its existence. Below the least existence
/// it leaves the map, and so does what the run did not see again where it has something else. `own`: the
/// run's own map; what is not in `earlier` is new.
ContinuedLandmarks continuedLandmarks(const std::vector<WeighedLandmark>& earlier,
                                      const std::vector<PlaceLook>& looks,
                                      const std::vector<WeighedLandmark>& candidates,
                                      const std::vector<LandmarkId>& own, const ContinuationRule& rule);

}  // namespace roomgraph
