// SPDX-License-Identifier: BSD-3-Clause
// Import of databases of RTAB-Map as rawlogs.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/sensor_poses.h"

namespace roomgraph {

/// Whether poses of nodes become odometry, which is planar in a rawlog.
enum class NodeOdometry {
  kAuto,    ///< when they stay on a floor: heights within 5 cm, tilts within 2 degrees
  kPlanar,  ///< always: x, y and yaw of them
  kNone,
};

struct RtabmapImportOptions {
  std::optional<int> session;  ///< map_id; nothing: the one with most nodes
  NodeOdometry odometry = NodeOdometry::kAuto;
  SensorPoses sensor_poses;         ///< robot_from_sensor by label, instead of the database's
  std::optional<int> jpeg_quality;  ///< of colour in the rawlog; nothing: without further loss
  bool external_images = false;     ///< images in X_Images/, JPEG as the database has it
};

struct RtabmapImportResult {
  std::string version;                 ///< of the database
  std::map<int, int> sessions;         ///< nodes by map_id
  int session = 0;                     ///< the one that was imported
  std::map<std::string, int> written;  ///< records by label
  std::map<std::string, int> skipped;  ///< parts of nodes left out by reason
  std::filesystem::path ground_truth;  ///< file written; empty when there is none
  std::string truth;                   ///< what it is: poses of the robot or of the camera
  std::vector<std::string> warnings;
};

/// Writes the nodes of one session of a database (X.db, SQLite, versions 0.11.2 to 0.23) as an
/// observation-only rawlog in order of time: CObservation3DRangeScan, label RGBD, of image, depth and
/// calibration; CObservation2DRangeScan, label LASER, of a 2D scan; CObservationOdometry, label ODOMETRY, of
/// Node.pose. Node.ground_truth_pose goes to X.groundtruth.txt: poses of the robot, or of the optical frame
/// of a camera that is at the robot's origin.
///
/// Images are taken as rectified, as RTAB-Map itself does. Of several cameras side by side the first is used.
/// A scan's points go into its beams, the nearest into each; without angles in the database (before 0.18)
/// into 720 of half a degree.
///
/// What is broken is left out, counted and told. Throws InputError (no database, nothing usable in it),
/// ConfigError (no such session, no such label, a place to write that is read) or RunError (output cannot be
/// written).
RtabmapImportResult importRtabmap(const std::filesystem::path& database, const std::filesystem::path& rawlog,
                                  const RtabmapImportOptions& options = {},
                                  const std::function<void(double share)>& progress = nullptr);

}  // namespace roomgraph
