// SPDX-License-Identifier: BSD-3-Clause
// Factors of the graph from object measurements: sightings, sides, boxes, sizes, points.
#pragma once

#include <map>
#include <vector>

#include "roomgraph/association/measurement_model.h"
#include "roomgraph/backend/factors.h"
#include "roomgraph/estimation/key_poses.h"
#include "roomgraph/estimation/object_frames.h"
#include "roomgraph/estimation/options.h"
#include "roomgraph/observations/landmark.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// Landmarks, points and factors of objects for the graph (method.md sec. 4, factors 2, 3, 4 and 6).
struct ObjectFactors {
  std::map<LandmarkId, double>
      yaws;  ///< that most sightings say; of the landmarks that sightings tie to poses
  /// Landmarks as they, or one end of them, seem from one direction, with the yaw of most sightings.
  std::map<LandmarkId, LandmarkEstimate> views;
  std::vector<LandmarkViewFactor> shared_errors;  ///< of views against their landmarks
  std::vector<LandmarkFactor> sightings;          ///< of views
  std::vector<LandmarkBoxFactor> boxes;
  std::vector<LandmarkSizeFactor> sizes;
  std::map<PointId, Eigen::Vector3d> points;  ///< in world, at the measured depth
  std::vector<CameraPointFactor> point_views;
  std::vector<PointLandmarkFactor> insides;
  std::vector<LandmarkSideFactor> sides;  ///< by scans
};

/// The current landmarks, and their factors with the key poses.
struct ObjectsInGraph {
  std::vector<Landmark> landmarks;
  ObjectFactors factors;
};

/// Builds the factors of all landmarks:
/// * Views: errors of sightings from one direction repeat, from frame to frame and when the robot comes back.
/// The landmark
///   as it seems from one direction is therefore a landmark of its own, and differs from the true one by an
///   error that all its sightings share (BackendOptions::landmark_repeating_share of their variance). The
///   sightings of one visit are averaged to one, which has the rest of the variance for itself, at the key
///   pose in the middle of the visit. Of an object whose size may be far from usual each end has views of its own:
///   sightings that hold it fast, placed as for the landmark's size.
/// * The mean size that was measured from each direction, and the mean of those that it has at least.
/// * One box per key pose and landmark, if the shape lifted from it explains it, and points that were seen on
/// a landmark from several key poses. Boxes from one direction, and points of one object, share a part of
/// their errors (BackendOptions::landmark_repeating_share), and are together worth no more than their mean. Of
/// boxes from one direction twelve at most are used, spread over time.
///
/// The yaw is that of most sightings; front and back of an object are easily confused, so opposite yaws are
/// reversed, and those across took width for depth and measure no yaw.
///
/// Weights are association probability x selection confidence x initialisation score. A measurement of
/// another class than its landmark's gives no factor. `model` (may be null) lowers the weight of measurements
/// that fit the viewing ray but not the depth, because their depth failed.
ObjectFactors objectFactors(const ObjectFrames& frames, const KeyPoses& poses,
                            const std::vector<Landmark>& landmarks, const ObjectDatabase& database,
                            const BackendOptions& options, const MeasurementModel* model = nullptr);

/// Factor between a key pose and the landmark of a measurement, as it was measured.
LandmarkFactor sightingOf(const ObjectDecision& decision, LandmarkId landmark, const KeyPose& node,
                          const Pose3& node_from_camera);

/// Mean of sightings of one landmark in one frame: the place of least weighted Cauchy losses, whose width is
/// `robust_width` standard deviations of each, so that a few whose depth failed do not count (0: every sighting
/// counts); and the weighted mean yaw. Covariance and weight are those of a single one of them. At least one sighting.
LandmarkFactor meanSighting(const std::vector<LandmarkFactor>& sightings, double robust_width);

}  // namespace roomgraph
