// SPDX-License-Identifier: BSD-3-Clause
// Agreement of several sightings of a place in an earlier map.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/options.h"

namespace roomgraph {

/// What can tell where in an earlier map the robot is.
enum class PlaceSource { kObjects, kScans, kImages };
std::string toString(PlaceSource source);

/// One source says where the robot was at one time.
struct PlaceSighting {
  PlaceSource source = PlaceSource::kScans;
  double t = 0;
  Pose3 map_from_robot = Pose3::Identity();
};

/// A place that enough sightings agree on.
struct ConfirmedPlace {
  Pose3 map_from_world = Pose3::Identity();
  std::vector<PlaceSource> sources;  ///< that agree, each once
  int sightings = 0;
};

/// Holds sightings back until enough of them agree (method.md sec. 4.9). One alone may be wrong, however well
/// it looks: rooms look alike.
class PlaceConsensus {
 public:
  explicit PlaceConsensus(const RelocalisationOptions& options) : options_(options) {}
  /// In order of time.
  void add(const PlaceSighting& sighting);
  /// The place that the latest sighting tells, when others of the last seconds agree with it and hardly any
  /// contradict: of two sources, or many of one that the robot got on a way. There must be a key pose.
  std::optional<ConfirmedPlace> confirmed(const KeyPoses& poses) const;

 private:
  RelocalisationOptions options_;
  std::vector<PlaceSighting> sightings_;
};

}  // namespace roomgraph
