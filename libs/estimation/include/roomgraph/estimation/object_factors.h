// SPDX-License-Identifier: BSD-3-Clause
// Factors of the graph from object measurements: sightings, sides, boxes, sizes, points.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/measurement_model.h"
#include "roomgraph/backend/factors.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_decision.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// What the graph is to know of objects (method.md sec. 4, factors 2, 3, 4 and 6).
struct ObjectFactors {
  std::vector<LandmarkFactor> sightings;
  std::map<LandmarkId, LandmarkEstimate> sides;  ///< landmarks as they seem from one side
  std::vector<LandmarkFactor> visits;            ///< sightings of sides
  std::vector<LandmarkBoxFactor> boxes;
  std::vector<LandmarkSizeFactor> sizes;
  std::map<PointId, Eigen::Vector3d> points;  ///< in world, as the measured depth has them
  std::vector<CameraPointFactor> views;
  std::vector<PointLandmarkFactor> insides;
};

/// The landmarks as they are now, and what ties them to the key poses.
struct ObjectsInGraph {
  std::vector<Landmark> landmarks;
  ObjectFactors factors;
};

/// Per key pose and landmark one sighting and one box: the errors of sightings from one place are nearly the
/// same, so that many count like one, and those from neighbouring places are alike: a single visit says
/// little of the robot's way (BackendOptions::landmark_information_share). But the error of one direction is
/// the same again when the robot comes back. Hence sides: what was seen from one direction in two visits or
/// more is also a landmark of its own, as far off the landmark as it likes, that ties the visits to each
/// other. All sightings of a visit count like one, from the key pose in the middle. Points that were seen on
/// a landmark from several key poses. Weights are association probability x selection confidence x
/// initialisation score. Measurements under another class' label say nothing of the place; those that rather
/// lie along the viewing ray, because their depth failed (`model`; may be null), little.
ObjectFactors objectFactors(const std::vector<ObjectFrame>& frames, const KeyPoses& poses,
                            const std::vector<Landmark>& landmarks, const ObjectDatabase& database,
                            const BackendOptions& options, const MeasurementModel* model = nullptr);

/// Factor between a key pose and the landmark a measurement was given to. A yaw that looks the other way than
/// the landmark's is turned round: front and back of an object are easily confused, its direction is not.
LandmarkFactor sightingOf(const ObjectDecision& decision, const Landmark& landmark, const KeyPose& node,
                          const Pose3& node_from_camera);

/// Weighted mean of sightings of one landmark from one key pose; covariance and weight are those of a single
/// one of them. At least one sighting.
LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings);

}  // namespace roomgraph
