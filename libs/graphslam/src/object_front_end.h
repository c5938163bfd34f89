// SPDX-License-Identifier: BSD-3-Clause
// Objects and the loops that they close, for an engine.
#pragma once

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "roomgraph/graphslam/seen_object.h"
#include "roomgraph/observations/trajectory.h"
#include "roomgraph/pipeline/record_sorter.h"
#include "roomgraph/pipeline/semantic_slam.h"

namespace roomgraph {

/// A run that maps objects beside an engine. It closes loops by objects alone, checked by scans and images as always;
/// those of scans and images are for other deciders.
class ObjectFrontEnd {
 public:
  explicit ObjectFrontEnd(std::unique_ptr<Setup> setup);
  ~ObjectFrontEnd();

  /// Records are put in order of time within [pipeline] lookahead_s first: boxes may be recorded after their image.
  void process(const Record& record);
  /// No more records will come.
  void end();
  /// Loops closed since the last call.
  std::vector<RelativePose> takeClosures();
  /// Objects seen since the last call, each with the time; node_from_object is robot_from_object at that time.
  std::vector<std::pair<double, SeenObject>> takeSeen();
  std::set<LandmarkId> confirmed() const;

 private:
  class Sightings;

  SemanticSlam slam_;
  RecordSorter sorter_;
  std::shared_ptr<Sightings> sightings_;
  std::size_t taken_ = 0;  ///< closures
};

}  // namespace roomgraph
