// SPDX-License-Identifier: BSD-3-Clause
// The semantic map: occupancy grid, landmarks and trajectory, serialisable with MRPT.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CSerializable.h>

#include <map>
#include <string>
#include <vector>

#include "roomgraph/observations/key_view.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/seen_span.h"

namespace roomgraph {

/// How a map came to be.
struct MapProvenance {
  std::string program;  ///< name, version and revision of what wrote it; empty in maps of version 0
  std::string config;   ///< config.ini as it was used
  std::string objects;  ///< objects.ini as it was used
  std::vector<std::string> history;  ///< what was done, the oldest first: "run of lab.rawlog"
};

/// The 2.5D semantic map (method.md sec. 6): occupancy grid, landmarks and the trajectory that made them, in
/// world.
class CSemanticMap : public mrpt::serialization::CSerializable {
  DEFINE_SERIALIZABLE(CSemanticMap, roomgraph)
 public:
  mrpt::maps::COccupancyGridMap2D::Ptr occupancy;  ///< null when nothing measured it
  std::vector<Landmark> landmarks;
  std::vector<StampedPose> world_from_robot;
  bool planar = true;  ///< false: a handheld camera moved freely
  std::string origin;  ///< the recording it was made from
  SeenSpans seen;      ///< of the landmarks for which it is known
  MapProvenance provenance;
  std::vector<KeyView> views;            ///< for re-localisation by images, in order of time
  std::map<LandmarkId, double> weights;  ///< sum of the weights of a landmark's sightings, where known
};

}  // namespace roomgraph
