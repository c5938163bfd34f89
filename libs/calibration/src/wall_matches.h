// SPDX-License-Identifier: BSD-3-Clause
// Depth cells matched with walls of the scans, by a calibration that may still be wrong.
#pragma once

#include <vector>

#include "evidence.h"
#include "roomgraph/calibration/sensor_parameters.h"

namespace roomgraph {

/// A part of a wall that camera and lidar saw at nearly one time.
struct WallMatch {
  std::size_t path = 0;           ///< of the lidar, at both times
  double scan_t = 0, view_t = 0;  ///< stamps, s
  ScanWall wall;                  ///< in the scan
  double wall_sigma_m = 0;        ///< of its distance, where the patch is
  DepthPatch patch;               ///< in the image
};

/// How far and how differently turned a cell may be seen by the calibration for a match.
struct MatchGate {
  double distance_m = 0.35, angle_rad = 0.35;
};

/// The matches of a recording: at most two for each wall and image, of its left and its right part. Heights
/// are compared with `lidar_z_m` above the floor.
std::vector<WallMatch> matchWalls(const RecordingEvidence& evidence, const ParameterVector& parameters,
                                  double lidar_z_m, const MatchGate& gate);

}  // namespace roomgraph
