// SPDX-License-Identifier: BSD-3-Clause
// The semantic map: occupancy grid, landmarks and trajectory, as a metric map of MRPT.
#pragma once

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/observations/key_view.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/map_options.h"
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
///
/// As a metric map of MRPT it is part of a CMultiMetricMap (`semanticMap_count = 1` in its ini; docs/mrpt.md
/// has the keys), takes observations of known poses, and tells the likelihood of scans and of detections at a
/// pose (method.md sec. 6.1). Copies share the grid until one of them takes an observation.
class CSemanticMap : public mrpt::maps::CMetricMap {
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
  MapLikelihoodOptions likelihood;       ///< of detections; the grid has its own for scans
  MapInsertionOptions insertion;

  bool isEmpty() const override;
  std::string asString() const override;  ///< one line: numbers of objects and cells
  /// Grid, objects as boxes and cylinders in the colours of their classes with their names, trajectory.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;
  /// Writes PREFIX.rgmap, PREFIX.3Dscene, PREFIX_objects.txt and the files of the grid, PREFIX_grid.*. Throws
  /// RunError.
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
  /// Those of the grid; nothing without one.
  void determineMatching2D(const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose2D& other_pose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extra) const override;
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* other, const mrpt::poses::CPose3D& other_pose,
                               const mrpt::maps::TMatchingRatioParams& params) const override;

  MAP_DEFINITION_START(CSemanticMap)
  std::string file;          ///< map.rgmap to begin with; empty: an empty map
  std::string objects_file;  ///< objects.ini, the classes of an empty map
  MapInsertionOptions insertion;
  MapLikelihoodOptions likelihood;
  mrpt::maps::COccupancyGridMap2D::TInsertionOptions grid_insertion;
  mrpt::maps::COccupancyGridMap2D::TLikelihoodOptions grid_likelihood;
  MAP_DEFINITION_END(CSemanticMap)

 private:
  void internal_clear() override;
  bool internal_insertObservation(const mrpt::obs::CObservation& observation,
                                  const std::optional<const mrpt::poses::CPose3D>& robot_pose) override;
  double internal_computeObservationLikelihood(const mrpt::obs::CObservation& observation,
                                               const mrpt::poses::CPose3D& robot_pose) const override;
  bool internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& observation) const override;
  bool insertIntoGrid(const mrpt::obs::CObservation& observation,
                      const std::optional<const mrpt::poses::CPose3D>& robot_pose);
};

}  // namespace roomgraph
