// SPDX-License-Identifier: BSD-3-Clause
// Straight pieces of wall in a scan.
#pragma once

#include "evidence.h"
#include "roomgraph/observations/scan.h"

namespace roomgraph {

/// Lines in returns that follow each other by angle: split at the farthest return and fitted by total least
/// squares (Nguyen, Martinelli, Tomatis and Siegwart 2005, "split and merge"). Points in the lidar's
/// horizontal frame, m; a piece has at least 8 returns and 0.4 m.
std::vector<ScanWall> findScanWalls(const std::vector<Eigen::Vector2d>& returns);

/// Returns of a scan in the horizontal frame of the lidar: its planar pose on the robot.
std::vector<Eigen::Vector2d> horizontalReturns(const Scan& scan);

}  // namespace roomgraph
