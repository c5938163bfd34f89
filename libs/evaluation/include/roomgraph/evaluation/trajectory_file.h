// SPDX-License-Identifier: BSD-3-Clause
// Trajectory read from a text file in TUM or planar format.
#pragma once

#include <filesystem>

#include "roomgraph/observations/trajectory.h"

namespace roomgraph {

/// A trajectory read from a text file, and how the file had to be corrected.
struct TrajectoryFile {
  Trajectory trajectory;  ///< sorted by time, one pose per stamp
  int duplicates = 0;     ///< lines dropped because an earlier line has the same stamp
  bool sorted = true;     ///< the file was in order of time
  bool planar = false;    ///< four columns
};

/// Reads `t tx ty tz qx qy qz qw` (TUM) or `t x y yaw` (MRPT's ground truth files); seconds, metres, radians.
/// Columns are separated by white space or commas; lines that start with # or % are comments. Throws
/// InputError with file and line for anything else, and when there is no pose at all.
TrajectoryFile readTrajectory(const std::filesystem::path& file);

}  // namespace roomgraph
